// quality [--effect NAME,NAME...] [--cases N] [--design 1|2|3] [--seed S] [--size N|any|limit]
// [--nose MM]
//
// One JSON object a line for every case; bench/quality_table.py makes docs/quality.md of them. How
// good the closed loop is: faces made by the process (tests/support/turning.hpp), with an
// effect the model does not declare, given to the loop, and what it says held against the truth.
// Off-grid shapes, amplitudes from half to fifty times the noise ("any") or what the program says
// of the same faces without the effect that it finds with 80 % probability ("limit"), one to three
// cuts.

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "slideway/base/text.hpp"
#include "slideway/trace/analysis.hpp"
#include "support/hidden_effect.hpp"

namespace {

using namespace slideway;           // NOLINT(google-build-using-namespace): the whole program
using namespace slideway::turning;  // NOLINT(google-build-using-namespace)
using Json = nlohmann::ordered_json;

struct Squareness {
  double bias = NAN;
  double u = 0.0, expanded = 0.0;  // 0: none is stated
};

Squareness squareness_of(const std::vector<FittedParameter>& parameters) {
  for (const FittedParameter& p : parameters)
    if (p.name == "squareness.dbeta_xz" && p.value)
      return {*p.value - kFaceSquareness, p.standard_uncertainty.value_or(0.0),
              p.expanded_uncertainty.value_or(0.0)};
  return {};
}

// Of the process' amplitude, in the unit of the effect's first parameter: rates are per the first
// cut.
double per_amplitude(const std::string& name) {
  return name == "linear_drift" ? 5.0 : name == "tool_wear" ? 17.3 : 1.0;
}

// The limit a result states for an effect of this shape: between two of the shapes it lists, on a
// line in the logarithms.
std::optional<double> limit_of(const TraceResult& result, const Hidden& hidden) {
  for (const DetectionLimit& limit : result.detection_limits) {
    if (limit.effect != hidden.name) continue;
    const auto& listed = limit.by_shape;
    if (listed.size() < 2) return limit.value;
    auto above = std::find_if(listed.begin() + 1, listed.end() - 1,
                              [&](const LimitAtShape& each) { return each.shape > hidden.shape; });
    const auto [s0, v0] = *std::prev(above);
    const auto [s1, v1] = *above;
    const double at = std::log(hidden.shape / s0) / std::log(s1 / s0);
    return v0 && v1 ? std::optional(*v0 * std::pow(*v1 / *v0, std::clamp(at, 0.0, 1.0)))
                    : std::nullopt;
  }
  return std::nullopt;
}

Json run_case(const std::string& name, int cuts, double size, bool at_limit, double nose_radius_mm,
              std::uint64_t seed) {
  RandomStream random(seed, name);
  const double amplitude = size * kFaceNoise;
  const Hidden hidden = make_hidden(name, amplitude, random);
  const std::vector<Profile> faces = make_faces(hidden, cuts, nose_radius_mm, seed);
  const Problem problem = face_problem();
  const Analysis analysis = analyse(problem, faces);
  const TraceResult& result = *analysis.trace;
  Json json{{"truth", name},
            {"cuts", cuts},
            {"at_limit", at_limit},
            {"size", size},
            {"seed", seed},
            {"shape", hidden.shape},
            {"verdict", text_of(result.verdict)},
            {"lack_of_fit_p", result.lack_of_fit_p}};
  json["accepted"] = Json::array();
  json["rivals"] = Json::array();
  for (const TraceRound& round : result.rounds) {
    json["accepted"].push_back(round.accepted);
    for (const std::string& rival : round.ambiguous_with) json["rivals"].push_back(rival);
  }
  if (const auto limit = limit_of(result, hidden)) json["limit"] = *limit;
  if (result.unnamed) {
    json["clock"] = result.unnamed->clock;
    json["unnamed_um"] = result.unnamed->rms_um.value_or(0.0);
    json["forms"] = Json::array();
    for (const UnnamedForm& form : result.unnamed->forms)
      json["forms"].push_back({form.form, form.delta_bic, form.instead_of});
  }
  const Squareness before = squareness_of(analysis.result.declared->parameters);
  const Squareness after = squareness_of(analysis.result.final->parameters);
  json["bias_before"] = before.bias;
  json["bias_after"] = after.bias;
  json["u_after"] = after.u;
  json["U_after"] = after.expanded;
  json["amplitude_um"] = amplitude / kMicrometre;
  json["truth_value"] = amplitude / kMicrometre / per_amplitude(name);
  for (const TraceRound& round : result.rounds)
    if (round.accepted == name && !round.parameters.empty())
      json["found_um"] = {round.parameters[0].value.value_or(0.0),
                          round.parameters[0].expanded_uncertainty.value_or(0.0)};
  json["tried"] = Json::array();
  for (const TraceRound& round : result.rounds) {
    json["tried"].push_back({round.accepted, round.delta_bic, "ACCEPTED"});
    for (const TriedEffect& tried : round.candidates)
      json["tried"].push_back({tried.effect, tried.delta_bic, tried.refused.value_or("")});
  }
  json["notes"] = result.notes;
  json["refused"] = Json::array();
  for (const TriedEffect& tried : result.refused)
    if (tried.delta_bic < -10.0)
      json["refused"].push_back({tried.effect, tried.delta_bic, tried.refused.value_or("")});
  json["not_separable"] = Json::array();
  for (const auto& [effect, same] : result.not_separable) json["not_separable"].push_back(effect);
  return json;
}

// The sizes of the effects hidden in one set of faces.
class Sizes {
 public:
  Sizes(const std::string& rule, int cuts, double nose_radius_mm, std::uint64_t seed)
      : rule_(rule), cuts_(cuts), nose_radius_mm_(nose_radius_mm), seed_(seed) {}

  // None where no limit is stated for it.
  std::optional<double> of(const std::string& name) {
    if (rule_ == "limit") return at_limit(name);
    if (rule_ != "any") return std::stod(rule_);
    RandomStream random(seed_, "size");
    return 0.5 * std::pow(100.0, random.uniform());
  }

 private:
  // The limit stated for these faces as they are without the effect.
  std::optional<double> at_limit(const std::string& name) {
    if (!clean_) clean_ = close_loop(face_problem(), make_faces({}, cuts_, nose_radius_mm_, seed_));
    RandomStream random(seed_, name);
    const auto limit = limit_of(*clean_, make_hidden(name, kFaceNoise, random));
    if (!limit) return std::nullopt;
    return *limit * per_amplitude(name) * kMicrometre / kFaceNoise;
  }

  std::string rule_;
  int cuts_;
  double nose_radius_mm_;
  std::uint64_t seed_;
  std::optional<TraceResult> clean_;
};

void run(std::map<std::string, std::string>& option) {
  std::vector<std::string> names;
  std::istringstream list(option["--effect"]);
  for (std::string name; std::getline(list, name, ',');) names.push_back(name);
  const int cuts = std::stoi(option["--design"]);
  const double nose_radius_mm = std::stod(option["--nose"]);
  const std::uint64_t first = std::stoull(option["--seed"]);
  for (std::uint64_t seed = first; seed < first + std::stoull(option["--cases"]); ++seed) {
    Sizes sizes(option["--size"], cuts, nose_radius_mm, seed);
    for (const std::string& name : names) {
      const std::optional<double> size = sizes.of(name);
      if (!size) continue;
      std::cout << run_case(name, cuts, *size, option["--size"] == "limit", nose_radius_mm, seed)
                << std::endl;
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::map<std::string, std::string> option{{"--cases", "1"},      {"--design", "3"},
                                            {"--effect", "clean"}, {"--seed", "1"},
                                            {"--size", "10"},      {"--nose", "2"}};
  for (int i = 1; i + 1 < argc; i += 2) option[argv[i]] = argv[i + 1];
  try {
    run(option);
  } catch (const std::exception& error) {
    std::cerr << "quality: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
