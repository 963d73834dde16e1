#pragma once

#include <optional>
#include <string>
#include <vector>

#include "coarse_view.hpp"
#include "extended_model.hpp"
#include "form_library.hpp"
#include "slideway/trace/trace.hpp"

namespace slideway {

/// A form held against what is left.
struct FormAttempt {
  std::string form;
  bool is_sum = false;
  Refined refined;
  double delta_bic = 0.0;                 // against the effects as accepted
  Eigen::Index unknowns = 0;              // beyond theirs
  std::optional<std::size_t> instead_of;  // the accepted effect it takes the place of
  const CoarseView* view = nullptr;       // of the model without that one
  std::optional<HeldOut> held_out;
};

/// What a candidate says of its cause that was made from a form.
inline constexpr const char* kUnknownCause = "not known: describes what was left without a name";

/// The form as the report has it.
/// @param before  with the effects as accepted
UnnamedForm told(const FormAttempt& attempt, const FormVariable& variable,
                 const std::vector<AcceptedEffect>& effects, const ModelResult& before);

}  // namespace slideway
