#pragma once

#include <cmath>

namespace slideway {

// Cosine and sine of angles that stay or come in even steps, by rotation: to 1e-10, which is what
// rounding leaves of even steps thousands of turns away. Where the steps change they are computed
// anew.
class Phasor {
 public:
  void turn_to(double angle) {
    if (angle == angle_) return;
    const double expected = start_ + (turned_ + 1) * step_;
    if (turned_ >= kLongest || !(std::abs(angle - expected) <= kSame)) {
      step_ = angle - angle_;
      start_ = angle;
      turned_ = 0;
      cosine_ = std::cos(angle);
      sine_ = std::sin(angle);
    } else {
      if (turned_ == 0) {
        step_cosine_ = std::cos(step_);
        step_sine_ = std::sin(step_);
      }
      const double cosine = cosine_ * step_cosine_ - sine_ * step_sine_;
      sine_ = sine_ * step_cosine_ + cosine_ * step_sine_;
      cosine_ = cosine;
      ++turned_;
    }
    angle_ = angle;
  }

  [[nodiscard]] double cosine() const { return cosine_; }
  [[nodiscard]] double sine() const { return sine_; }

 private:
  static constexpr int kLongest = 256;
  static constexpr double kSame = 1e-10;
  double angle_ = NAN, start_ = NAN, step_ = NAN;
  int turned_ = 0;
  double cosine_ = 1.0, sine_ = 0.0, step_cosine_ = 1.0, step_sine_ = 0.0;
};

}  // namespace slideway
