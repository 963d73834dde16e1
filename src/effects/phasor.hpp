#pragma once

#include <cmath>

namespace slideway {

// Cosine and sine of angles one after the other. Where the steps between them are even, or change
// slowly, they come by rotation: by the step, which itself turns by its change. The steps add up to
// the angle without an error of their own, so rotations leave only their rounding, below 1e-13;
// elsewhere, and now and then, both are computed anew.
class Phasor {
 public:
  void turn_to(double angle) {
    const double step = angle - angle_;
    if (step == 0.0) return;
    const double change = step - step_;
    angle_ = angle;
    step_ = step;
    if (turned_ >= kLongest || !(std::abs(change) <= kSlow)) {
      turned_ = 0;
      cosine_ = std::cos(angle);
      sine_ = std::sin(angle);
      return;
    }
    if (turned_ == 0) {
      step_cosine_ = std::cos(step);
      step_sine_ = std::sin(step);
    } else {
      // Taylor: what is left out is below kSlow⁵ / 120 = 1e-17.
      const double square = change * change;
      rotate(step_cosine_, step_sine_, 1.0 - square * (0.5 - square / 24.0),
             change * (1.0 - square / 6.0));
    }
    rotate(cosine_, sine_, step_cosine_, step_sine_);
    ++turned_;
  }

  [[nodiscard]] double cosine() const { return cosine_; }
  [[nodiscard]] double sine() const { return sine_; }

 private:
  static constexpr int kLongest = 256;     // rotations
  static constexpr double kSlow = 1.0e-3;  // rad

  static void rotate(double& cosine, double& sine, double by_cosine, double by_sine) {
    const double turned = cosine * by_cosine - sine * by_sine;
    sine = sine * by_cosine + cosine * by_sine;
    cosine = turned;
  }

  double angle_ = NAN, step_ = NAN;
  int turned_ = 0;
  double cosine_ = 1.0, sine_ = 0.0, step_cosine_ = 1.0, step_sine_ = 0.0;
};

}  // namespace slideway
