#include "search_band.hpp"

#include <algorithm>

#include "slideway/profile/means.hpp"

namespace slideway {
namespace {

constexpr int kMeansLevel = 3;  // 2^3 means to a value

bool has_more_values(const Observation& observation, std::size_t most) {
  const LowBandOptions& options = observation.low_band.options();
  return with_at_most(options, observation.profile->positions.size(), most).level > options.level;
}

/// The profile as its search looks at it, with the low band that leaves it few enough values.
Profile with_fewer_samples(const Problem& problem, const Profile& profile, std::size_t most) {
  LowBandOptions options =
      with_at_most(problem.low_band_of(profile), profile.positions.size(), most);
  if (options.wavelet != "db1" || options.level <= kMeansLevel) return profile;
  Profile out = means_of(profile, std::size_t{1} << (options.level - kMeansLevel));
  options.level = kMeansLevel;
  out.low_band = options;
  return out;
}

}  // namespace

std::unique_ptr<SearchBand> search_band(const Problem& problem,
                                        const std::vector<Profile>& profiles,
                                        const FittedModel& declared,
                                        const std::vector<ShownEffect>& shown) {
  const auto most = static_cast<std::size_t>(declared.model.gates.search_values);
  const auto is_long = [&](const Observation& each) { return has_more_values(each, most); };
  if (std::ranges::none_of(declared.model.observations, is_long)) return nullptr;
  std::vector<Profile> thin;
  for (const Profile& profile : profiles)
    thin.push_back(with_fewer_samples(problem, profile, most));
  Model model = build_model(problem, thin, most);  // points into the profiles
  append_settled(model, shown);
  FittedModel fitted = fit_model(std::move(model));
  return std::make_unique<SearchBand>(SearchBand{std::move(thin), std::move(fitted)});
}

}  // namespace slideway
