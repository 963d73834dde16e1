#pragma once

#include "selection.hpp"
#include "slideway/trace/trace.hpp"

namespace slideway {

/// Short formulas that describe what is left without a name, over the variable of most evidence:
/// complexity against evidence, as symbolic regression has it.
///
/// Each form (form_library.hpp) becomes a candidate effect of the user's own and is searched as the
/// catalogue is: beside the model, levelling and the accepted effects, or in the place of one of
/// these that is of the same variable, under the noise of the last search. ΔBIC counts amplitudes
/// and shapes, and 2 ln of the number of forms. A form is told if it lowers the BIC by
/// Gates::delta_bic against nothing and against every simpler form, is determined and brings
/// Gates::form_share of the best one's; at most Gates::most_forms.
std::vector<UnnamedForm> describe_in_forms(ModelExtender& extender,
                                           const std::vector<AcceptedEffect>& effects,
                                           const Unnamed& unnamed);

/// What shows whether the cause goes with that variable.
std::string what_separates(const Unnamed& unnamed);

}  // namespace slideway
