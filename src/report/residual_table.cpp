#include "slideway/report/residual_table.hpp"

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "summary.hpp"

namespace slideway {

std::string residual_table(const Analysis& analysis, const std::string& source) {
  if (!analysis.trace || !analysis.trace->unnamed || analysis.trace->unnamed->curve.at.empty())
    throw DataError(
        "no table: nothing is left without a name; accepted: a report of identify "
        "whose verdict is unnamed");
  const Unnamed& left = *analysis.trace->unnamed;
  const UnnamedCurve& curve = left.curve;
  const std::string unit(text_of(curve.value_unit));
  std::string text = "# " + source + "\n# left without a name in " + left.profile + ": " +
                     likeness(left) + "\n" + curve.variable + "_" + curve.unit + ",residual_" +
                     unit + ",expanded_uncertainty_" + unit + "\n";
  for (std::size_t i = 0; i < curve.at.size(); ++i)
    text += shortest(curve.at[i]) + "," + shortest(curve.residual[i]) + "," +
            shortest(curve.expanded_uncertainty[i]) + "\n";
  return text;
}

}  // namespace slideway
