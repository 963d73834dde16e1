#include "slideway/identify/design.hpp"

#include "slideway/identify/fit.hpp"
#include "slideway/identify/left_out.hpp"

namespace slideway {

DesignRank rank_of_design(Model model) {
  for (Observation& observation : model.observations)
    leave_out(observation, values_at_axis(observation, model.machine));
  require_enough_data(model);
  Estimate middle = initial_estimate(model);
  middle.amplitudes.setOnes();
  const Linearisation linear = linearise(model, middle);
  std::vector<Noise> noise;
  for (const Observation* observation : linear.observations)
    noise.push_back(Noise::white(observation->profile->standard_uncertainty.value_or(1.0),
                                 observation->values.size()));
  const Compressed compressed = compress(linear, noise);
  const Rank rank = analyse_rank(compressed.triangle, compressed.scale, model.gates.rank_tolerance);
  const Eigen::MatrixXd jacobian = all_parameters(model, middle).jacobian;
  const NullDirections null =
      null_directions(model, rank, jacobian, parameter_scale(jacobian, compressed.scale));
  DesignRank out{{}, undetermined(model, null)};
  const std::vector<std::string> names = model.parameter_names();
  for (std::size_t p = 0; p < names.size(); ++p)
    if (null.identifiable[p]) out.determined.push_back(names[p]);
  return out;
}

}  // namespace slideway
