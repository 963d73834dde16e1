#include "drawn_json.hpp"

#include <nlohmann/json.hpp>

#include "answer.hpp"
#include "slideway/batch/item.hpp"
#include "slideway/report/report.hpp"

namespace slideway {
namespace {

using Json = nlohmann::ordered_json;

/// A number that JSON has and a double does not.
constexpr const char* kTooLarge = "1e999";

const std::vector<Json>& foreign_values() {
  static const std::vector<Json> kValues{nullptr,
                                         true,
                                         0,
                                         -1,
                                         1e300,
                                         -1e-300,
                                         18446744073709551615U,
                                         "",
                                         "x",
                                         "nan",
                                         kTooLarge,
                                         "\xE2\x80\xAE",
                                         std::string(300, 'w'),
                                         Json::array(),
                                         Json::object(),
                                         Json::array({0, 1}),
                                         Json::array({nullptr}),
                                         Json{{"", 0}}};
  return kValues;
}

/// A value of the document, found by going down.
Json& descend(Draw& draw, Json& root) {
  Json* at = &root;
  while (!at->empty() && at->is_structured() && !draw.once_in(12)) {
    auto child = at->begin();
    std::advance(child, draw.below(std::min<std::size_t>(at->size(), 65536)));
    at = &*child;
  }
  return *at;
}

void change(Draw& draw, Json& root) {
  Json& value = descend(draw, root);
  switch (draw.below(6)) {
    case 0:
      if (value.is_number()) value = value.get<double>() * draw.one_of(std::array{-1.0, 0.0, 1e9});
      break;
    case 1:
      if (value.is_structured() && !value.empty()) value.erase(value.begin());
      break;
    case 2:
      if (value.is_array() && !value.empty()) value.push_back(Json(value.front()));
      break;
    case 3:
      value = Json(descend(draw, root));
      break;
    default:
      value = draw.one_of(foreign_values());
  }
}

DrawnProblem whole_problem() {
  std::vector<std::uint8_t> bytes;
  for (unsigned i = 0; i < 400; ++i) bytes.push_back(static_cast<std::uint8_t>(i * i * 37 + i));
  Draw draw(bytes);
  DrawnProblem problem = draw_problem(draw, Intent::legal);
  problem.head =
      "title = \"whole\"\n[about]\nmachine = \"M\"\noperator = \"O\"\nlaboratory = \"L, Street "
      "1\"\n"
      "certificate = \"1\"\ndate = \"2026-11-23\"\nplace = \"laboratory\"\ncountry = \"DE\"\n"
      "responsible = \"R\"\ncustomer = \"C\"\n[machine]\nlever = \"paper\"\n[low_band]\nlevel = "
      "1\n";
  for (DrawnProfile& profile : problem.profiles)
    profile.keys = "kind = \"slide\"\nquantity = \"" +
                   std::string(profile.is_slope ? "slope" : "height") + "\"\n";
  problem.tail =
      "[[effect]]\nname = \"straightness\"\ndegree = 3\n[trace]\ncandidates = [\"step\"]\n"
      "[tolerance]\nstraightness_um = 5\n";
  return problem;
}

}  // namespace

std::string draw_json(Draw& draw, const std::string& sound) {
  Json root = Json::parse(sound);
  for (std::size_t left = 1 + draw.below(8); left > 0; --left) change(draw, root);
  std::string text = root.dump(-1, ' ', false, Json::error_handler_t::replace);
  const std::string quoted = '"' + std::string(kTooLarge) + '"';
  for (std::size_t at; (at = text.find(quoted)) != std::string::npos;)
    text.replace(at, quoted.size(), kTooLarge);
  return text;
}

const std::string& sound_report() {
  static const std::string kReport = [] {
    const Answer answer =
        answer_to(ProblemFiles(whole_problem()), {.with_details = true, .with_curves = true});
    require(answer.analysis.has_value(), "no sound report: " + answer.refusal);
    return json_report(*answer.analysis);
  }();
  return kReport;
}

std::string sound_line(const std::string& id) {
  static const std::string kBegins = "{\"id\":\"\"", kLine = [] {
    const ProblemFiles files(whole_problem());
    return identify_item({.id = "", .problem = files.path()}, {});
  }();
  require(kLine.starts_with(kBegins), "no sound line: " + kLine.substr(0, 200));
  return "{\"id\":\"" + id + '"' + kLine.substr(kBegins.size());
}

}  // namespace slideway
