#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "areal.hpp"
#include "numbers.hpp"
#include "registry.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "writable.hpp"
#include "x3p_checksum.hpp"
#include "x3p_points.hpp"
#include "xml.hpp"
#include "zip_archive.hpp"

// X3P (ISO 25178-72, ISO 5436-2): a zip archive of main.xml, its MD5 and, mostly, the points in
// binary. All lengths are in metres.
namespace slideway {
namespace {

// Numbers as text deflate to a third or so.
constexpr std::size_t kFreeXml = std::size_t{1} << 20U;
constexpr std::size_t kXmlExpansion = 20;
constexpr std::string_view kNamespace = "http://www.opengps.eu/2008/ISO5436_2";

// How many points there are: so many in each row of a matrix, or all in a list.
struct Dimensions {
  std::size_t columns = 1;
  std::size_t rows = 1;
  [[nodiscard]] std::size_t points() const { return columns * rows; }
};

Dimensions read_dimensions(pugi::xml_node record) {
  Dimensions size;
  const auto count = [&](const std::string& path) {
    const std::string place = "main.xml: Record3";
    return read_count(text_of(element(record, path.c_str(), place)), place + "/" + path);
  };
  if (record.child("ListDimension")) {
    size.columns = count("ListDimension");
    return size;
  }
  size.columns = count("MatrixDimension/SizeX");
  size.rows = count("MatrixDimension/SizeY");
  if (count("MatrixDimension/SizeZ") != 1)
    throw DataError("main.xml: Record3/MatrixDimension/SizeZ: several layers; accepted: 1");
  if (size.rows > (std::size_t{1} << 62U) / size.columns / 32)
    throw DataError("main.xml: Record3/MatrixDimension: more points than any file holds");
  return size;
}

X3pPoints read_points(const ZipArchive& archive, pugi::xml_node record, const X3pAxes& axes,
                      std::size_t count, ChecksumGate& gate) {
  if (const pugi::xml_node list = record.child("DataList"))
    return read_data_list(list, axes, count);
  const pugi::xml_node link = element(record, "DataLink", "main.xml: Record3");
  const auto linked = [&](const char* name, const char* checksum, std::size_t size) {
    const std::string file(text_of(link.child(name)));
    std::string bytes = archive.read(file, size);
    if (bytes.size() != size)
      throw DataError(printable(file, 60) + ": " + std::to_string(bytes.size()) +
                      " bytes; the points declared need " + std::to_string(size));
    gate.check(bytes, text_of(link.child(checksum)), printable(file, 60));
    return bytes;
  };
  const std::string data =
      linked("PointDataLink", "MD5ChecksumPointData", count * axes.point_bytes());
  std::string valid;
  if (!text_of(link.child("ValidPointsLink")).empty())
    valid = linked("ValidPointsLink", "MD5ChecksumValidPoints", (count + 7) / 8);
  return read_binary(data, valid, axes, count);
}

void check_main(const ZipArchive& archive, pugi::xml_node root, std::string_view main,
                ChecksumGate& gate) {
  constexpr std::size_t kMostChecksum = 4096;
  std::string name(text_of(root.first_element_by_path("Record4/ChecksumFile")));
  if (name.empty()) name = "md5checksum.hex";
  const std::string digits = archive.contains(name) ? archive.read(name, kMostChecksum) : "";
  gate.check(main, Words(digits).next().value_or(""), "main.xml");
}

// A point that is missing altogether, as <Datum/> says, has no position where x is stored.
std::size_t drop_without_position(X3pPoints& points) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    if (std::isnan(points.x[i])) continue;
    points.x[kept] = points.x[i];
    points.z[kept++] = points.z[i];
  }
  const std::size_t dropped = points.x.size() - kept;
  points.x.resize(kept);
  points.z.resize(kept);
  return dropped;
}

// Positions along an axis that is counted; one alone needs no increment.
std::vector<double> counted(const X3pAxis& axis, std::size_t count) {
  std::vector<double> positions(count, axis.offset);
  for (std::size_t i = 1; i < count; ++i) positions[i] = axis.coordinate(static_cast<double>(i));
  return positions;
}

Trace profile_of(X3pPoints points, const X3pAxes& axes) {
  std::size_t dropped = 0;
  if (points.x.empty())
    points.x = counted(axes.x, points.z.size());
  else
    dropped = drop_without_position(points);
  if (points.x.empty()) throw DataError("main.xml: Record3: no point has a position");
  Trace trace{std::move(points.x), std::move(points.z), "m", "m", {}};
  if (dropped > 0)
    trace.decisions.push_back(std::to_string(dropped) +
                              " missing points have no position and are left out");
  return trace;
}

Grid grid_of(X3pPoints points, const X3pAxes& axes, const Dimensions& size) {
  if (points.x.empty() && points.y.empty())
    return {counted(axes.x, size.columns), counted(axes.y, size.rows), std::move(points.z)};
  // One coordinate stored, the other counted.
  const std::vector<double> columns = counted(axes.x, size.columns);
  const std::vector<double> rows = counted(axes.y, size.rows);
  for (std::size_t i = 0; points.x.size() < points.z.size(); ++i)
    points.x.push_back(columns[i % size.columns]);
  for (std::size_t i = 0; points.y.size() < points.z.size(); ++i)
    points.y.push_back(rows[i / size.columns]);
  return grid_of_points(points.x, points.y, std::move(points.z));
}

std::string incremental_axis(const std::string& name, double increment, double offset) {
  return std::string("<") + name + "><AxisType>I</AxisType><DataType>D</DataType><Increment>" +
         shortest(increment) + "</Increment><Offset>" + shortest(offset) + "</Offset></" + name +
         ">";
}

std::string absolute_axis(const std::string& name) {
  return std::string("<") + name + "><AxisType>A</AxisType><DataType>D</DataType></" + name + ">";
}

class X3p final : public Format {
 public:
  [[nodiscard]] std::string_view name() const override { return "X3P"; }
  [[nodiscard]] std::span<const std::string_view> endings() const override {
    static constexpr std::string_view kEndings[] = {".x3p"};
    return kEndings;
  }
  [[nodiscard]] bool recognises(std::string_view bytes) const override {
    return bytes.starts_with("PK\x03\x04") || bytes.starts_with("PK\x05\x06");
  }
  [[nodiscard]] Trace read(std::string_view bytes, const TraceRequest& request) const override;
  [[nodiscard]] std::string write(const Trace& trace) const override;
};

Trace X3p::read(std::string_view bytes, const TraceRequest& request) const {
  const ZipArchive archive(bytes);
  ChecksumGate gate(request.ignore_checksum);
  const std::string main =
      archive.read("main.xml", std::max(kFreeXml, kXmlExpansion * bytes.size()));
  const auto document = parse_xml(main, Doctype::refused, "main.xml");
  const pugi::xml_node root = document->document_element();
  if (!std::string_view(root.name()).ends_with("ISO5436_2"))
    throw DataError("main.xml: the root is '" + printable(root.name()) + "'; accepted: ISO5436_2");
  check_main(archive, root, main, gate);

  const std::string_view feature = text_of(element(root, "Record1/FeatureType", "main.xml"));
  if (feature != "PRF" && feature != "SUR" && feature != "PCL")
    throw DataError("main.xml: Record1/FeatureType: '" + printable(feature) +
                    "'; accepted: PRF, SUR, PCL");
  const X3pAxes axes = read_axes(root);
  const pugi::xml_node record = element(root, "Record3", "main.xml");
  const Dimensions size = read_dimensions(record);
  X3pPoints points = read_points(archive, record, axes, size.points(), gate);

  Trace trace;
  if (feature == "PRF" && size.rows == 1) {
    refuse_line(request, "an X3P file of type PRF");
    trace = profile_of(std::move(points), axes);
  } else {
    trace = line_of(grid_of(std::move(points), axes, size), request, "m");
  }
  // The standard gives absolute axes no increment, and the reference library passes over it.
  for (const X3pAxis* axis : {&axes.x, &axes.y, &axes.z})
    if (!axis->incremental && axis->scale() != 1.0)
      trace.decisions.push_back(axis->place + ": absolute, yet with an Increment of " +
                                shortest(axis->scale()) + ": values are multiplied by it");
  trace.decisions.insert(trace.decisions.end(), gate.decisions().begin(), gate.decisions().end());
  return trace;
}

std::string X3p::write(const Trace& trace) const {
  check_lengths(trace, "X3P");
  std::vector<double> x;
  for (const double position : trace.positions)
    x.push_back(converted(position, trace.position_unit, "m"));
  // Counted if that gives the very same positions, else stored one by one.
  const double step = x.size() > 1 ? x[1] - x[0] : 0.0;
  const bool even = step > 0.0 && x == even_positions(x.size(), x[0], step);
  std::string data;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!even) append_little_endian(data, x[i]);
    append_little_endian(data, converted(trace.values[i], trace.value_unit, "m"));
  }
  const std::string main =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<p:ISO5436_2 xmlns:p=\"" +
      std::string(kNamespace) +
      "\">\n<Record1><Revision>ISO5436 - 2000</Revision><FeatureType>PRF</FeatureType>\n<Axes>" +
      (even ? incremental_axis("CX", step, x[0]) : absolute_axis("CX")) +
      incremental_axis("CY", 1.0, 0.0) + absolute_axis("CZ") +
      "</Axes></Record1>\n<Record3><MatrixDimension><SizeX>" + std::to_string(x.size()) +
      "</SizeX><SizeY>1</SizeY><SizeZ>1</SizeZ></MatrixDimension>\n"
      "<DataLink><PointDataLink>bindata/data.bin</PointDataLink><MD5ChecksumPointData>" +
      md5(data) +
      "</MD5ChecksumPointData></DataLink></Record3>\n"
      "<Record4><ChecksumFile>md5checksum.hex</ChecksumFile></Record4>\n</p:ISO5436_2>\n";
  const std::array<std::pair<std::string, std::string>, 3> files{
      {{"main.xml", main},
       {"md5checksum.hex", md5(main) + " *main.xml\n"},
       {"bindata/data.bin", data}}};
  return zip_archive(files);
}

}  // namespace

const Format& x3p_format() {
  static const X3p kFormat;
  return kFormat;
}

}  // namespace slideway
