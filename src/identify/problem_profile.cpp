#include "problem_profile.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "slideway/base/units.hpp"

namespace slideway {
namespace {

constexpr std::string_view kKeys =
    "name file kind quantity position_column value_column position_unit value_unit time_column "
    "time_unit delimiter decimal encoding header_lines line base_mm window mask leave_out from_mm "
    "to_mm "
    "center_mm z_mm overhang_mm feed_mm_per_min spindle_rpm cut_direction cut_radius_mm start_s "
    "traverse_mm_per_s nose_radius_mm azimuth_deg surface instrument level wavelet boundary free "
    "loss reversed standard_uncertainty role";

constexpr double kFullTurn = 360.0;

std::filesystem::path data_directory(const Section& section, std::string_view key,
                                     const ProblemRules& rules) {
  if (!rules.data_dir)
    section.fail(key,
                 "needs the directory ${SLIDEWAY_DATA}, which is not set; accepted: --data DIR or "
                 "the environment variable SLIDEWAY_DATA");
  return std::filesystem::absolute(*rules.data_dir);
}

}  // namespace

std::filesystem::path resolved(const Section& section, std::string_view key, std::string file,
                               const ProblemRules& rules) {
  constexpr std::string_view kVariable = "${SLIDEWAY_DATA}";
  if (const std::size_t at = file.find(kVariable); at != std::string::npos)
    file.replace(at, kVariable.size(), data_directory(section, key, rules).string());
  else if (file.find("${") != std::string::npos)
    section.fail(key, "unknown variable in '" + file + "'; accepted: ${SLIDEWAY_DATA}");
  return rules.base / file;
}

namespace {

std::string checked_name(const Section& section) {
  std::string name = section.required("name", section.text("name"), "a name of its own");
  if (name.find_first_of("/\\") != std::string::npos)
    section.refuse("name", "'" + name + "' must not hold a slash: files are named after it");
  return name;
}

void read_units(const Section& section, const ProblemRules& rules, ProfileEntry& entry) {
  constexpr std::string_view kPositionUnits = "m mm um nm inch s";
  const bool slope = entry.profile.setup.quantity == Quantity::slope;
  const std::string_view value_units = slope ? kSlopeUnits : kLengthUnits;
  ProfileSource& source = entry.source;
  const auto position = section.unit("position_unit", kPositionUnits, " for a position");
  const auto value =
      section.unit("value_unit", value_units, slope ? " for a slope" : " for a height");
  const StatedUnits stated =
      position && value ? StatedUnits{} : stated_units(source.path, source.request);
  std::error_code unknown;
  const bool is_absent = rules.file_is_needed && !source.path.empty() &&
                         !std::filesystem::exists(source.path, unknown);
  const auto need = [&](const char* key, std::string_view accepted) {
    if (!section.has(key) && !is_absent)  // which is said where it is read
      section.refuse(key, "missing; accepted: " + std::string(accepted));
  };
  if (!position && (!stated.position || source.window || !source.mask.empty()))
    need("position_unit", kPositionUnits);
  if (!value && (!stated.value || section.has("standard_uncertainty")))
    need("value_unit", value_units);
  source.position_unit = position.value_or("");
  source.value_unit = value.value_or("");
  const bool timed = section.has("time_column");
  if (section.has("time_unit") && !timed)
    section.missing("time_column", "a column, or no time_unit");
  if (timed)
    source.time_unit =
        section.required("time_unit", section.one_of("time_unit", kTimeUnits), kTimeUnits);
}

TraceRequest read_request(const Section& section) {
  TraceRequest request;
  request.position_column = section.column("position_column").value_or(request.position_column);
  request.value_column = section.column("value_column").value_or(request.value_column);
  request.time_column = section.column("time_column").value_or("");
  request.delimiter = section.one_of("delimiter", ", ; tab blank").value_or("");
  request.decimal = section.one_of("decimal", ". ,").value_or("");
  request.encoding = section.one_of("encoding", "utf-8 utf-16 latin-1").value_or("");
  request.header_lines = section.integer("header_lines", 0, std::numeric_limits<int>::max());
  request.line = section.text("line").value_or("");
  return request;
}

void read_source(const Section& section, const ProblemRules& rules, ProfileEntry& entry) {
  ProfileSource& source = entry.source;
  if (rules.file_is_needed || section.has("file")) {
    section.attempt([&] {
      entry.profile.file = section.required("file", section.text("file"), "path of a data file");
      source.path = resolved(section, "file", entry.profile.file, rules);
    });
  }
  source.request = read_request(section);
  source.window = section.range("window");
  source.mask = section.ranges("mask");
  if (section.is_text("leave_out"))
    source.leave_out_spikes = section.one_of("leave_out", "spikes").has_value();
  else
    source.left_out_rows =
        section
            .indices("leave_out",
                     "must be \"spikes\" or a list of data rows, the first one 1: [120, 121]")
            .value_or(source.left_out_rows);
  read_units(section, rules, entry);
}

void read_geometry(const Section& section, const ProfileDefaults& machine, Setup& setup) {
  if (section.one_of("kind", "face slide") == "slide") setup.kind = Kind::slide;
  if (section.one_of("quantity", "height slope") == "slope") setup.quantity = Quantity::slope;
  setup.base_mm = section.magnitude("base_mm");
  if (setup.base_mm && setup.quantity != Quantity::slope)
    section.refuse("base_mm", "belongs to quantity = \"slope\" only");
  setup.center_mm = section.coordinate("center_mm").value_or(0.0);
  setup.spindle_position_mm = machine.spindle_position_mm;
  setup.z_mm = section.coordinate("z_mm").value_or(0.0);
  setup.overhang_mm = section.coordinate("overhang_mm").value_or(machine.overhang_mm);
  check_overhang(section, setup.overhang_mm, machine.lever);
}

void read_cut(const Section& section, bool position_is_time, Setup& setup) {
  setup.feed_mm_per_min = section.magnitude("feed_mm_per_min");
  if (position_is_time && !section.has("feed_mm_per_min"))
    section.refuse("feed_mm_per_min",
                   "missing; accepted: a feed greater than 0, which position_unit = \"s\" needs to "
                   "become a position");
  setup.spindle_rpm = section.magnitude("spindle_rpm");
  if (const auto direction = section.one_of("cut_direction", "inward outward"))
    setup.cut_direction = *direction == "inward" ? CutDirection::inward : CutDirection::outward;
  setup.cut_radius_mm = section.magnitude("cut_radius_mm");
  setup.start_s = section.coordinate("start_s").value_or(0.0);
  setup.traverse_mm_per_s = section.magnitude("traverse_mm_per_s");
  setup.nose_radius_mm = section.magnitude("nose_radius_mm");
  if (setup.nose_radius_mm && setup.kind != Kind::face)
    section.refuse("nose_radius_mm", "belongs to kind = \"face\" only");
  setup.reversed = section.flag("reversed").value_or(false);
  if (section.has("reversed") && setup.kind != Kind::slide)
    section.refuse("reversed", "belongs to kind = \"slide\" only");
  setup.azimuth_deg = section.coordinate("azimuth_deg", kFullTurn).value_or(0.0);
  if (section.has("azimuth_deg") && setup.kind != Kind::face)
    section.refuse("azimuth_deg", "belongs to kind = \"face\" only");
}

std::optional<Line> read_line(const Section& section) {
  const bool begins = section.has("from_mm");
  if (begins != section.has("to_mm"))
    section.missing(begins ? "to_mm" : "from_mm", "[x, y] of both ends of the line, or of none");
  const auto from = section.point("from_mm"), to = section.point("to_mm");
  if (!from || !to) return std::nullopt;
  if (*from == *to) section.fail("to_mm", "is from_mm; accepted: the other end of the line");
  return Line{*from, *to};
}

void read_treatment(const Section& section, ProfileEntry& entry) {
  Profile& profile = entry.profile;
  if (const auto free = section.some_of("free", words("offset tilt"))) {
    profile.free_offset = std::find(free->begin(), free->end(), "offset") != free->end();
    profile.free_tilt = std::find(free->begin(), free->end(), "tilt") != free->end();
  }
  if (const auto uncertainty = section.positive("standard_uncertainty")) {
    constexpr double kSmallest = 1e-15, kLargest = 1e12;  // mm, rad
    const std::string& unit = entry.source.value_unit;
    const bool slope = profile.setup.quantity == Quantity::slope;
    if (const auto scale = slope ? slope_unit(unit) : length_unit(unit)) {
      profile.standard_uncertainty = (*scale)(*uncertainty);
      if (*profile.standard_uncertainty < kSmallest || *profile.standard_uncertainty > kLargest)
        section.refuse("standard_uncertainty", shortest(*uncertainty) +
                                                   " is out of range; accepted: from " +
                                                   shortest(kSmallest / (*scale)(1.0)) + " to " +
                                                   shortest(kLargest / (*scale)(1.0)) + " " + unit);
    }
  }
  const auto loss = section.one_of("loss", "none huber cauchy");
  if (loss)
    profile.loss = *loss == "huber" ? Loss::huber : *loss == "cauchy" ? Loss::cauchy : Loss::none;
  if (section.one_of("role", "fit holdout") == "holdout") profile.role = Role::holdout;
}

}  // namespace

void check_overhang(const Section& section, double overhang_mm, Lever lever) {
  if (overhang_mm != 0.0 && lever != Lever::split && section.has("overhang_mm"))
    section.refuse("overhang_mm", "has no meaning here; accepted: only with lever = \"split\"");
}

LowBandOptions read_low_band(const Section& section, LowBandOptions defaults) {
  constexpr int kHighestLevel = 30;
  std::vector<std::string> wavelets;
  for (int n = 1; n <= 19; ++n) wavelets.push_back("db" + std::to_string(n));
  defaults.wavelet = section.one_of("wavelet", wavelets).value_or(defaults.wavelet);
  defaults.level = section.integer("level", 0, kHighestLevel).value_or(defaults.level);
  if (const auto name = section.one_of("boundary", kBoundaries))
    defaults.boundary = boundary(*name);
  return defaults;
}

ProfileEntry read_profile_entry(const Section& section, const ProfileDefaults& defaults,
                                const ProblemRules& rules) {
  section.accept(kKeys);
  ProfileEntry entry;
  section.attempt([&] { entry.profile.name = checked_name(section); });
  entry.lines = section.lines();
  read_geometry(section, defaults, entry.profile.setup);
  read_source(section, rules, entry);
  read_cut(section, entry.source.position_unit == "s", entry.profile.setup);
  section.attempt([&] { entry.profile.line = read_line(section); });
  entry.profile.surface = section.text("surface");
  entry.profile.instrument = section.text("instrument");
  if (std::ranges::any_of(words(kLowBandKeys), [&](const auto& key) { return section.has(key); }))
    entry.profile.low_band = read_low_band(section, defaults.low_band);
  read_treatment(section, entry);
  return entry;
}

}  // namespace slideway
