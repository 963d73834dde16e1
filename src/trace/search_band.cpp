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

}  // namespace

Profile in_means(const Profile& profile, LowBandOptions options) {
  const bool is_long = options.wavelet == "db1" && options.level > kMeansLevel;
  Profile out =
      is_long ? means_of(profile, std::size_t{1} << (options.level - kMeansLevel)) : profile;
  if (is_long) options.level = kMeansLevel;
  out.low_band = std::move(options);
  return out;
}

std::unique_ptr<SearchBand> search_band(const Problem& problem,
                                        const std::vector<Profile>& profiles,
                                        const FittedModel& whole) {
  const auto most = static_cast<std::size_t>(whole.model.gates.search_values);
  const auto is_long = [&](const Observation& each) { return has_more_values(each, most); };
  if (std::ranges::none_of(whole.model.observations, is_long)) return nullptr;
  std::vector<Profile> thin;
  std::vector<LowBandOptions> low_bands;
  for (const Profile& profile : profiles)
    thin.push_back(
        in_means(profile, low_bands.emplace_back(with_at_most(problem.low_band_of(profile),
                                                              profile.positions.size(), most))));
  Model model = build_model(problem, thin, most);  // points into the profiles
  model.terms = whole.model.terms;
  FittedModel fitted = fit_model(std::move(model), whole.fit.estimate.shapes);
  return std::make_unique<SearchBand>(
      SearchBand{std::move(thin), std::move(low_bands), std::move(fitted)});
}

}  // namespace slideway
