#pragma once

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "identify/cases.hpp"

/// Reference datasets of NIST as profiles along the slide, and how answers compare.
namespace slideway::nist {

/// Readings y by position x, without levelling. A profile has no position twice: the j-th reading
/// at a position goes to the j-th profile.
inline std::vector<Profile> profiles(const std::multimap<double, double>& points) {
  std::vector<std::vector<double>> x, y;
  std::size_t repeat = 0;
  for (auto point = points.begin(); point != points.end(); ++point) {
    repeat = point != points.begin() && std::prev(point)->first == point->first ? repeat + 1 : 0;
    x.resize(std::max(x.size(), repeat + 1));
    y.resize(x.size());
    x[repeat].push_back(point->first);
    y[repeat].push_back(point->second);
  }
  std::vector<Profile> out;
  for (std::size_t i = 0; i < x.size(); ++i) {
    out.push_back(cases::profile("repeat" + std::to_string(i), Kind::slide, x[i], y[i]));
    out.back().free_offset = out.back().free_tilt = false;
  }
  return out;
}

/// A set of linear regression: coefficients from x⁰ on, by the published exact solution.
struct Certified {
  std::vector<double> coefficients, deviations;
  double residual_deviation = 0.0;
};

/// Rows of a table, without comments and header.
inline std::vector<std::vector<std::string>> rows(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::vector<std::string>> out;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream fields(line);
    out.emplace_back();
    for (std::string field; std::getline(fields, field, ',');) out.back().push_back(field);
  }
  out.erase(out.begin());
  return out;
}

inline Certified certified(const std::filesystem::path& folder, const std::string& set) {
  Certified out;
  for (const auto& row : rows(folder / "certified.csv")) {
    if (row[0] != set) continue;
    out.coefficients.push_back(std::stod(row[3]));
    out.deviations.push_back(std::stod(row[4]));
    out.residual_deviation = std::stod(row[6]);
  }
  return out;
}

/// The readings of a set of linear regression, y by x.
inline std::multimap<double, double> points(const std::filesystem::path& folder,
                                            const std::string& set) {
  std::multimap<double, double> out;
  for (const auto& row : rows(folder / (set + ".csv")))
    out.emplace(std::stod(row[0]), std::stod(row[1]));
  return out;
}

/// A file of nonlinear regression: starts, certified values and deviations by number of b; the
/// readings.
struct File {
  std::map<int, std::vector<double>> certified;  // start 1, start 2, value, deviation
  double residual_deviation = 0.0;
  std::multimap<double, double> points;
};

inline std::vector<double> numbers_in(const std::string& text) {
  std::istringstream in(text);
  std::vector<double> out;
  for (double value; in >> value;) out.push_back(value);
  return out;
}

inline File read(const std::filesystem::path& path) {
  File out;
  std::ifstream in(path);
  bool data = false;
  for (std::string line; std::getline(in, line);) {
    int b = 0, skip = 0;
    if (std::sscanf(line.c_str(), " b%d = %n", &b, &skip) == 1 && skip > 0)
      out.certified[b] = numbers_in(line.substr(skip));
    if (line.starts_with("Residual Standard Deviation:"))
      out.residual_deviation = std::stod(line.substr(line.find(':') + 1));
    if (const std::vector<double> row = numbers_in(line); data && row.size() == 2)
      out.points.emplace(row[1], row[0]);
    data |= line.starts_with("Data:") && line.find('x') != std::string::npos;
  }
  return out;
}

/// Digits in which a number agrees with the certified one.
inline double digits(double found, double certified) {
  return found == certified ? 15.0 : -std::log10(std::abs(found / certified - 1.0));
}

}  // namespace slideway::nist
