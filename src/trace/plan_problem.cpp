#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "slideway/trace/plan.hpp"

namespace slideway {
namespace {

/// Keys of a [[profile]] table, in the order they are given.
class Keys {
 public:
  void text(const char* key, const std::string& value) {
    std::string quoted = "\"";
    for (const char c : value)
      quoted += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
    line(key, quoted + "\"");
  }
  void number(const char* key, const std::optional<double>& value) {
    if (!value) return;
    std::string digits = shortest(*value);
    if (digits.find_first_of(".e") == std::string::npos) digits += ".0";
    line(key, digits);
  }
  void line(const char* key, const std::string& value) {
    text_.append(key).append(" = ").append(value).append("\n");
  }

  [[nodiscard]] const std::string& all() const { return text_; }

 private:
  std::string text_;
};

void add_setup(const Setup& setup, Keys& keys) {
  keys.number("base_mm", setup.base_mm);
  if (setup.kind == Kind::face) {
    keys.number("center_mm", setup.center_mm);
    keys.number("cut_radius_mm", setup.cut_radius_mm);
    keys.number("nose_radius_mm", setup.nose_radius_mm);
    if (setup.azimuth_deg != 0.0) keys.number("azimuth_deg", setup.azimuth_deg);
  }
  keys.number("z_mm", setup.z_mm);
  if (setup.overhang_mm != 0.0) keys.number("overhang_mm", setup.overhang_mm);
  keys.number("feed_mm_per_min", setup.feed_mm_per_min);
  keys.number("spindle_rpm", setup.spindle_rpm);
  if (setup.cut_direction)
    keys.text("cut_direction", setup.cut_direction == CutDirection::inward ? "inward" : "outward");
  keys.number("traverse_mm_per_s", setup.traverse_mm_per_s);
}

void add_treatment(const Profile& profile, bool is_slope, Keys& keys) {
  if (profile.surface) keys.text("surface", *profile.surface);
  if (profile.instrument) keys.text("instrument", *profile.instrument);
  if (profile.low_band) {
    keys.text("wavelet", profile.low_band->wavelet);
    keys.line("level", std::to_string(profile.low_band->level));
    keys.text("boundary", std::string(name(profile.low_band->boundary)));
  }
  std::vector<std::string> free;
  if (profile.free_offset) free.emplace_back("\"offset\"");
  if (profile.free_tilt) free.emplace_back("\"tilt\"");
  keys.line("free", std::string("[").append(joined(free)).append("]"));
  if (profile.standard_uncertainty)
    keys.number("standard_uncertainty",
                *profile.standard_uncertainty / (is_slope ? kMicroradian : kMicrometre));
}

/// When the cut starts is not known before it is made. A log is wrong of another time, so it must
/// be filled in then; without one, what the plan took it to be stands.
void add_start(const Setup& setup, bool has_log, Keys& keys) {
  if (has_log)
    keys.line("start_s",
              "nan  # fill in: when the cut began, by the clock of the log, which has "
              "to go on until its end");
  else if (setup.start_s != 0.0)
    keys.line("start_s", shortest(setup.start_s) + "  # as planned; change it to what it was");
}

std::string profile_text(const CutToCome& cut, bool has_log) {
  const Profile& profile = cut.profile;
  const Setup& setup = profile.setup;
  const bool is_slope = setup.quantity == Quantity::slope;
  std::string text = "\n# To be measured: " + cut.what +
                     (cut.like.empty() ? "" : ", all else as " + cut.like) + ".\n# " +
                     std::to_string(profile.positions.size()) + " positions from " +
                     significant(setup.first_mm, 6) + " to " + significant(setup.last_mm, 6) +
                     " mm, into the file below, with a line of headings: x_mm, " +
                     (is_slope ? "slope_urad" : "z_um") +
                     (setup.reading_times ? ", t_s: when each was read" : "") + ".\n[[profile]]\n";
  Keys keys;
  keys.text("name", profile.name);
  keys.text("file", profile.name + ".csv");
  keys.text("kind", setup.kind == Kind::face ? "face" : "slide");
  keys.text("quantity", is_slope ? "slope" : "height");
  keys.text("position_column", "x_mm");
  keys.text("value_column", is_slope ? "slope_urad" : "z_um");
  keys.text("position_unit", "mm");
  keys.text("value_unit", is_slope ? "urad" : "um");
  if (setup.reading_times) {
    keys.text("time_column", "t_s");
    keys.text("time_unit", "s");
  }
  add_setup(setup, keys);
  add_start(setup, has_log, keys);
  add_treatment(profile, is_slope, keys);
  return text + keys.all();
}

}  // namespace

std::string planned_problem_text(const Problem& problem, const std::vector<CutToCome>& cuts,
                                 const std::filesystem::path& directory) {
  std::string text = moved_problem_text(problem, directory);
  const bool has_log = text.find("\n[[channel]]") != std::string::npos;
  for (const CutToCome& cut : cuts) text += profile_text(cut, has_log);
  return text;
}

}  // namespace slideway
