#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace slideway {

// Lines of known phase in equally dense samples, each held against the spectrum beside it.
//
// What a cubic leaves of the values, under a Hann window, is fitted with a cosine and a sine of the
// phase. What that takes away is compared with what the same phase takes away when it runs some
// cycles more or less over the samples: under noise that is even there the ratio has an F
// distribution of 2 and 2 m degrees of freedom, so p = (1 + ratio / m)^-m.
class LineTest {
 public:
  // `places` of the values along the trace; `radii`, of which their form is a function. A weight of
  // 0 leaves a value out. REQUIRES 16 values at least, as many places, radii and weights.
  LineTest(std::span<const double> values, const Eigen::VectorXd& places,
           const Eigen::VectorXd& radii, const Eigen::VectorXd& weights);

  // Probability that noise makes a line as strong. `phase` (rad), one for each value.
  [[nodiscard]] double p_value(const Eigen::VectorXd& phase) const;

  // Whether the lines beside it are faster than what the form and a slow noise leave, and its phase
  // is shown: sampling has not folded it to half a cycle a sample.
  [[nodiscard]] bool is_fast(const Eigen::VectorXd& phase) const;

  // Of lines: amplitudes of the cosine and the sine of each, fitted together, and their standard
  // uncertainties by the spectrum beside each of them.
  struct Amplitudes {
    Eigen::VectorXd values, uncertainties;
  };
  [[nodiscard]] Amplitudes amplitudes(const std::vector<Eigen::VectorXd>& phases) const;

  // Whether its cosine and sine are more than those of other lines: less than `share` of their
  // square is theirs.
  [[nodiscard]] bool stands_apart(const Eigen::VectorXd& phase,
                                  const std::vector<Eigen::VectorXd>& others, double share) const;

 private:
  [[nodiscard]] Eigen::MatrixXd weighted(const Eigen::MatrixXd& columns) const;
  [[nodiscard]] Eigen::MatrixX2d columns(const Eigen::VectorXd& phase) const;
  [[nodiscard]] Eigen::MatrixXd columns(const std::vector<Eigen::VectorXd>& phases) const;
  [[nodiscard]] double gain(const Eigen::MatrixX2d& own) const;
  // Mean of the lines beside a line, and how many of them it does not reach, folded. `wave`: its
  // cosine and sine; `own`: its columns.
  struct Beside {
    double mean = 0.0;
    double count = 0.0;
  };
  [[nodiscard]] Beside gain_beside(const Eigen::MatrixX2d& wave, const Eigen::MatrixX2d& own) const;

  Eigen::VectorXd window_;
  Eigen::MatrixXd form_;    // orthonormal: the cubic under the window
  Eigen::VectorXd values_;  // what it leaves of them
  // Cosines and sines, side by side, of 4 to 9 cycles over the places.
  Eigen::ArrayXXd turned_;
  double turn_of_form_;  // of one cycle over the radii, from value to value, in cycles
};

// Probability that noise makes two estimates of one line, each a cosine and a sine with its
// standard uncertainties, as unlike as these.
double p_of_equal_lines(const Eigen::Vector2d& one, const Eigen::Vector2d& of_one,
                        const Eigen::Vector2d& other, const Eigen::Vector2d& of_other);

}  // namespace slideway
