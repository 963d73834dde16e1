#include <algorithm>
#include <cmath>
#include <numbers>

#include "html_curves.hpp"
#include "html_parts.hpp"
#include "slideway/report/number.hpp"

/// Turned faces as maps: the form of each surface around its axis, between the traces that were
/// read.
namespace slideway {
namespace {

constexpr int kRings = 14, kSectors = 36, kColours = 9;  // of a map
constexpr double kSide = 360.0, kDisc = 140.0;           // of the picture; radius of the disc
constexpr double kScaleTop = 322.0, kScaleCell = 24.0;
constexpr std::size_t kMostMaps = 6;

/// The part of a trace on one side of the axis.
struct Spoke {
  double azimuth_deg = 0.0;
  std::vector<double> radius_mm, height_um;
};

struct Surface {
  std::string name;
  std::vector<Spoke> spokes;
  std::vector<const ProfileCurves*> traces;
};

double turned(double degrees) { return degrees - 360.0 * std::floor(degrees / 360.0); }

std::vector<Spoke> spokes_of(const ModelResult& model, const ProfileCurves& curves, double centre,
                             double azimuth_deg) {
  const CurveSet form = form_curves(curves);
  const std::vector<double>& low = form.curves.front().values;
  if (low.size() != form.position_mm.size()) return {};
  const std::vector<double> height = levelled(model, curves.profile, form.position_mm, low);
  Spoke ahead{turned(azimuth_deg), {}, {}}, behind{turned(azimuth_deg + 180.0), {}, {}};
  for (std::size_t i = 0; i < height.size(); ++i) {
    const double at = form.position_mm[i] - centre;
    if (!std::isfinite(at) || !std::isfinite(height[i])) return {};
    Spoke& own = at < 0.0 ? behind : ahead;
    own.radius_mm.push_back(std::abs(at));
    own.height_um.push_back(height[i]);
  }
  std::ranges::reverse(behind.radius_mm);
  std::ranges::reverse(behind.height_um);
  std::vector<Spoke> out;
  for (Spoke* const each : {&ahead, &behind})
    if (each->radius_mm.size() > 2 && std::ranges::is_sorted(each->radius_mm))
      out.push_back(std::move(*each));
  return out;
}

std::vector<Surface> surfaces_of(const Analysis& analysis) {
  std::vector<Surface> out;
  const Result& result = analysis.result;
  for (const ProfileCurves& curves : analysis.details.curves->profiles) {
    const auto in = std::ranges::find(result.inputs, curves.profile, &InputSummary::name);
    const auto setup =
        std::ranges::find(analysis.details.setups, curves.profile, &ProfileSetup::profile);
    if (in == result.inputs.end() || setup == analysis.details.setups.end()) continue;
    if (in->kind != Kind::face || in->quantity != Quantity::height) continue;
    const std::string name = in->surface.value_or(curves.profile);
    auto surface = std::ranges::find(out, name, &Surface::name);
    if (surface == out.end()) surface = out.insert(surface, Surface{name, {}, {}});
    for (Spoke& each :
         spokes_of(*result.final, curves, setup->setup.center_mm, in->azimuth_deg.value_or(0.0)))
      surface->spokes.push_back(std::move(each));
    surface->traces.push_back(&curves);
  }
  for (Surface& each : out) std::ranges::sort(each.spokes, {}, &Spoke::azimuth_deg);
  return out;
}

/// Between the two spokes beside a direction, linear in the angle.
double height_at(const Surface& surface, double radius, double azimuth_deg) {
  const std::vector<Spoke>& spokes = surface.spokes;
  const auto on = [&](const Spoke& spoke) {
    return interpolated(spoke.radius_mm, spoke.height_um, {radius}).front();
  };
  const auto next = std::ranges::upper_bound(spokes, azimuth_deg, {}, &Spoke::azimuth_deg);
  const Spoke& right = next == spokes.end() ? spokes.front() : *next;
  const Spoke& left = next == spokes.begin() ? spokes.back() : *std::prev(next);
  const double gap = turned(right.azimuth_deg - left.azimuth_deg);
  const double share = gap > 0.0 ? turned(azimuth_deg - left.azimuth_deg) / gap : 0.0;
  return (1.0 - share) * on(left) + share * on(right);
}

std::string point(double radius, double azimuth_deg) {
  const double angle = azimuth_deg * std::numbers::pi / 180.0;
  return fixed_point(kSide / 2.0 + radius * std::cos(angle), 1) + " " +
         fixed_point(kSide / 2.0 - 14.0 - radius * std::sin(angle), 1);
}

Html cell(double inner, double outer, double from_deg, double to_deg, int colour) {
  const auto arc = [](double radius, const char* sweep, double to) {
    const std::string r = fixed_point(radius, 1);
    return "A" + r + " " + r + " 0 0 " + sweep + " " + point(radius, to);
  };
  return element("path", {{"class", numbered("f", static_cast<std::size_t>(colour))},
                          {"d", "M" + point(inner, from_deg) + "L" + point(outer, from_deg) +
                                    arc(outer, "0", to_deg) + "L" + point(inner, to_deg) +
                                    arc(inner, "1", from_deg) + "Z"}});
}

Html scale(double most) {
  Html out;
  const double left = (kSide - kColours * kScaleCell) / 2.0;
  for (int i = 0; i < kColours; ++i)
    out += element("rect", {{"class", numbered("f", static_cast<std::size_t>(i))},
                            {"x", fixed_point(left + i * kScaleCell, 1)},
                            {"y", fixed_point(kScaleTop, 1)},
                            {"width", fixed_point(kScaleCell, 1)},
                            {"height", "12"}});
  const auto label = [&](double x, const std::string& text) {
    return element("text",
                   {{"x", fixed_point(x, 1)},
                    {"y", fixed_point(kScaleTop + 26.0, 1)},
                    {"text-anchor", "middle"}},
                   text);
  };
  return out + label(left, "−" + to_digits(most, 2)) + label(kSide / 2.0, "0 µm") +
         label(kSide - left, "+" + to_digits(most, 2));
}

Html map_of(const Surface& surface, const std::string& id) {
  double rim = 0.0, hub = INFINITY, most = 0.0;
  for (const Spoke& spoke : surface.spokes) {
    rim = std::max(rim, spoke.radius_mm.back());
    hub = std::min(hub, spoke.radius_mm.front());
    for (const double height : spoke.height_um) most = std::max(most, std::abs(height));
  }
  if (!(rim > hub) || !(most > 0.0) || !std::isfinite(rim) || !std::isfinite(most)) return {};
  Html content;
  const double step = (rim - hub) / kRings;
  for (int ring = 0; ring < kRings; ++ring)
    for (int sector = 0; sector < kSectors; ++sector) {
      const double from = 360.0 / kSectors * sector, to = 360.0 / kSectors * (sector + 1);
      const double height = height_at(surface, hub + (ring + 0.5) * step, 0.5 * (from + to));
      const int colour = static_cast<int>(
          std::lround((std::clamp(height / most, -1.0, 1.0) + 1.0) / 2.0 * (kColours - 1)));
      content += cell(kDisc * (hub + ring * step) / rim, kDisc * (hub + (ring + 1) * step) / rim,
                      from, to, colour);
    }
  for (const Spoke& spoke : surface.spokes)
    content += element("path", {{"class", "trace"},
                                {"d", "M" + point(kDisc * hub / rim, spoke.azimuth_deg) + "L" +
                                          point(kDisc + 6.0, spoke.azimuth_deg)}});
  return svg_element(
      {id, "Face " + surface.name + " as a map",
       "Height around the axis, blue low, red high, between the traces that were read.",
       fixed_point(kSide, 0), fixed_point(kSide, 0)},
      content + scale(most));
}

Html sections(const ModelResult& model, const Surface& surface, const std::string& id) {
  Plot plot({id, "Face " + surface.name + ": its profiles",
             "The form of each trace of the face over the trace position.", "trace position, mm",
             "height, µm"});
  plot.size(kSide, kSide);
  std::size_t style = 0;
  for (const ProfileCurves* const trace : surface.traces) {
    const CurveSet form = form_curves(*trace);
    plot.line(trace->profile, numbered("e", style++ % kStyles), form.position_mm,
              levelled(model, trace->profile, form.position_mm, form.curves.front().values));
  }
  return plot.empty() ? Html() : plot.svg();
}

}  // namespace

HtmlSection html_face(const Analysis& analysis) {
  if (!analysis.result.final || !analysis.details.curves) return {};
  Html body;
  std::size_t index = 0;
  for (const Surface& surface : surfaces_of(analysis)) {
    if (index == kMostMaps) break;
    if (surface.spokes.empty()) continue;
    const std::string id = numbered("face", index++);
    const Html map = map_of(surface, id);
    if (map.empty()) continue;
    body += element(
        "figure", element("div", {{"class", "panels"}},
                          map + sections(*analysis.result.final, surface, id + "-sections")) +
                      element("figcaption",
                              bold(surface.name) +
                                  ": height of the face, levelled as the problem file allows, blue "
                                  "low and red high; lines: where it was read. Between them the "
                                  "height is interpolated around the axis."));
  }
  return {"face", "The face as a map", body};
}

}  // namespace slideway
