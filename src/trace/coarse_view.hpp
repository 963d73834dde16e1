#pragma once

#include "slideway/identify/fit.hpp"
#include "whitened.hpp"

namespace slideway {

/// A fitted model with one sample for each low-band value: what is smooth beside the spacing of
/// these values has the same columns, and costs a 32nd. Rows are in units of a sample, so white
/// rows are those of the model itself.
class CoarseView {
 public:
  /// @param under  noise and undescribed values of the rows; the fit must outlive the view
  CoarseView(const FittedModel& fitted, const Whitened& under);
  CoarseView(const CoarseView&) = delete;
  CoarseView& operator=(const CoarseView&) = delete;
  CoarseView(CoarseView&&) = default;
  CoarseView& operator=(CoarseView&&) = delete;
  ~CoarseView() = default;

  [[nodiscard]] const FittedModel& fitted() const { return *fitted_; }
  [[nodiscard]] const Model& model() const { return model_; }  // of the fitted profiles, no terms
  [[nodiscard]] const Linearisation& linear() const { return linear_; }
  [[nodiscard]] const Whitened& data() const { return data_; }

 private:
  Model take_in();
  [[nodiscard]] Linearisation scaled() const;
  [[nodiscard]] Whitened whitened(const Whitened& under) const;

  const FittedModel* fitted_;
  std::vector<double> scales_;  // low-band value of a signal of 1
  std::vector<Profile> profiles_;
  Model model_;
  Linearisation linear_;
  Whitened data_;
};

}  // namespace slideway
