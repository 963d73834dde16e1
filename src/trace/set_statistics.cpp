#include "set_statistics.hpp"

#include "kept.hpp"

namespace slideway {
namespace {

using SetOfEffects = SetStatistics::Effects;

std::vector<const Candidate*> candidates_of(const SetOfEffects& effects) {
  std::vector<const Candidate*> out;
  for (const AcceptedEffect& effect : effects) out.push_back(effect.candidate);
  return out;
}

}  // namespace

double SetStatistics::gain_beside(const Effects& effects, std::size_t which) {
  return kept_or_made(gains_, {candidates_of(effects), which, effects[which].shape}, [&] {
    extender_.limit().check();
    const FittedModel& with = extender_.extended(effects);
    const FittedModel& without = extender_.extended(all_but(effects, which));
    const Whitened data(without.fit.linear, with.fit.noise);
    const AcceptedEffect& effect = effects[which];
    const Projection own =
        project(data, stacked_columns(without.model, effect.candidate->term, effect.shape,
                                      data.rows() - data.values()));
    return own.gain - penalty(data, *effect.candidate, own.rank);
  });
}

double SetStatistics::over_process(const Effects& effects, std::size_t which) {
  return kept_or_made(over_process_, {candidates_of(effects), which, {}}, [&] {
    extender_.limit().check();
    return gain_over_process(extender_, effects, which);
  });
}

double SetStatistics::price(const Effects& effects) {
  const Whitened& data = extender_.search({}).data;
  double sum = 0.0;
  for (const AcceptedEffect& effect : effects)
    sum += penalty(data, *effect.candidate, effect.candidate->amplitudes());
  return sum;
}

double SetStatistics::lead(const Effects& effects, const Effects& other) {
  return kept_or_made(leads_, {candidates_of(effects), candidates_of(other)}, [&] {
    const Whitened& data = extender_.search(effects).data;
    const Whitened without(extender_.extended(other).fit.linear, data.noise(), data.undescribed());
    return without.residual().squaredNorm() + price(other) - data.residual().squaredNorm() -
           price(effects);
  });
}

Standing SetStatistics::standing(const Effects& effects, const Gates& gates) {
  Standing out;
  const auto make = [&] {
    extender_.limit().check();
    return unnamed_rivals(extender_, effects);
  };
  for (const UnnamedRival& rival : kept_or_made(rivals_, candidates_of(effects), make)) {
    const double asked = rival.is_process ? gates.process_margin : gates.local_form_margin;
    if (rival.behind - asked < out.margin)
      out = {rival.behind - asked, rival.name, rival.in_place_of};
  }
  return out;
}

}  // namespace slideway
