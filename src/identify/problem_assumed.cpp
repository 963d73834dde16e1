#include "problem_assumed.hpp"

#include <algorithm>
#include <array>

#include "slideway/base/text.hpp"
#include "slideway/effects/catalogue.hpp"

namespace slideway {
namespace {

constexpr const char* kDefault = "default";
constexpr const char* kFromTrace = "largest radius of the trace";

bool has_time(const Setup& setup) { return setup.feed_mm_per_min && setup.cut_direction; }

/// Whether a declared effect puts something else into a face at another place along Z.
bool depends_on_z(const Problem& problem, Setup setup) {
  constexpr std::array<double, 4> kPositions{1.0, 2.0, 5.0, 10.0};
  const Machine machine = problem.machine();
  const TravelRange range{0.0, 10.0, 0.0, 1.0, 0.0, problem.beam_span_mm};
  setup.center_mm = 0.0;
  setup.first_mm = kPositions.front();
  setup.last_mm = kPositions.back();
  setup.cut_radius_mm = kPositions.back();
  const auto differs = [&](const DeclaredEffect& declared) {
    const auto effect = make_effect(declared.name, declared.options, machine, range);
    if (!effect->shapes().empty() || !effect->applies_to(setup) || !effect->lacking(setup).empty())
      return false;  // none with a shape has a Z
    std::array<Eigen::MatrixXd, 2> columns;
    for (std::size_t i = 0; i < 2; ++i) {
      setup.z_mm = static_cast<double>(i);
      columns[i].resize(kPositions.size(), effect->amplitudes());
      effect->columns({kPositions, setup, machine}, {}, columns[i]);
    }
    return columns[0] != columns[1];
  };
  return std::ranges::any_of(problem.effects, differs);
}

class Assumed {
 public:
  Assumed(const Section& section, const std::string& name) : section_(section), name_(name) {}

  void add(const char* key, std::string value, const char* why = kDefault) {
    if (!section_.has(key)) list.push_back({"profile." + name_ + "." + key, std::move(value), why});
  }

  std::vector<Assumption> list;

 private:
  const Section& section_;
  const std::string& name_;
};

std::vector<Assumption> of_profile(const Section& section, const Problem& problem,
                                   const Profile& profile, bool machine_has_overhang) {
  const Setup& setup = profile.setup;
  Assumed out(section, profile.name);
  out.add("free", R"(["offset", "tilt"])");
  if (setup.kind == Kind::face) {
    out.add("center_mm", "0");
    if (has_time(setup)) out.add("cut_radius_mm", "", kFromTrace);
    if (problem.lever == Lever::split && !machine_has_overhang) out.add("overhang_mm", "0");
    if (depends_on_z(problem, setup)) out.add("z_mm", "0");
  }
  const auto timed = std::ranges::count_if(
      problem.profiles, [](const ProfileEntry& each) { return has_time(each.profile.setup); });
  if (has_time(setup) && timed > 1) out.add("start_s", "0");
  const bool turned = std::ranges::any_of(problem.profiles, [](const ProfileEntry& each) {
    return each.lines.contains("azimuth_deg");
  });
  if (setup.kind == Kind::face && turned) out.add("azimuth_deg", "0");
  return out.list;
}

}  // namespace

std::vector<Assumption> assumed_by(const Section& root, const Problem& problem) {
  std::vector<Assumption> out;
  const std::optional<Section> low_band = root.table("low_band");
  const bool level_is_used = std::ranges::any_of(
      problem.profiles, [](const ProfileEntry& each) { return !each.profile.low_band; });
  if (level_is_used && !(low_band && low_band->has("level")))
    out.push_back({"low_band.level", std::to_string(problem.low_band.level), kDefault});
  const std::optional<Section> machine = root.table("machine");
  const std::vector<Section> sections = root.tables("profile");
  for (std::size_t i = 0; i < sections.size(); ++i)
    std::ranges::move(of_profile(sections[i], problem, problem.profiles[i].profile,
                                 machine && machine->has("overhang_mm")),
                      std::back_inserter(out));
  return out;
}

std::vector<Assumption> assumptions(const Problem& problem, const std::vector<Profile>& profiles) {
  std::vector<Assumption> out = problem.assumed;
  for (Assumption& each : out)
    for (const Profile& profile : profiles)
      if (each.value.empty() && each.key == "profile." + profile.name + ".cut_radius_mm")
        each.value = shortest(profile.setup.cut_radius_mm.value());
  return out;
}

}  // namespace slideway
