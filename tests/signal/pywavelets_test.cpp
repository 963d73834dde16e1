#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <span>
#include <sstream>

#include "base/temporary_folder.hpp"
#include "signal/noise.hpp"
#include "slideway/base/text.hpp"
#include "slideway/signal/decomposition.hpp"

namespace slideway::pywavelets_test {
namespace {

using testing::DoubleNear;
using testing::Pointwise;

struct Case {
  Wavelet wavelet;
  Boundary boundary = Boundary::zero;
  int level = 0;
  std::vector<double> signal;
};

// PyWavelets 1.1.1 does not return from reflecting a single sample about itself.
bool is_answered(const Case& each) {
  if (each.boundary != Boundary::reflect && each.boundary != Boundary::antireflect) return true;
  std::size_t n = each.signal.size();
  for (int level = 0; level < each.level; ++level) {
    if (n < 2) return false;
    n = dwt_length(n, each.wavelet.taps(), each.boundary);
  }
  return true;
}

// Every wavelet with every boundary, at four lengths of 1 to 200 and 1 to 4 levels each.
std::vector<Case> make_cases() {
  RandomStream random(3, "pywavelets");
  std::vector<Case> cases;
  for (int number = 1; number <= 19; ++number)
    for (int mode = 0; mode <= static_cast<int>(Boundary::antireflect); ++mode)
      for (int level = 1; level <= 4; ++level) {
        Case each{
            daubechies("db" + std::to_string(number)), static_cast<Boundary>(mode), level, {}};
        const double range = level == 1 ? 40.0 : 200.0;  // short ones too
        each.signal.resize(1 + static_cast<std::size_t>(range * random.uniform()));
        for (double& value : each.signal) value = random.normal();
        if (is_answered(each)) cases.push_back(std::move(each));
      }
  return cases;
}

void write_cases(const std::vector<Case>& cases, const std::filesystem::path& path) {
  std::ofstream file(path);
  for (const Case& each : cases) {
    file << each.wavelet.name << ' ' << name(each.boundary) << ' ' << each.level;
    for (const double value : each.signal) file << ' ' << shortest(value);
    file << '\n';
  }
}

// What a command prints, and its exit code.
std::pair<std::string, int> output_of(const std::string& command) {
  std::string text;
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return {"", 127};
  char buffer[65536];
  for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) text.append(buffer, n);
  const int status = pclose(pipe);
  return {text, WIFEXITED(status) ? WEXITSTATUS(status) : -1};
}

std::vector<double> next_line(std::istream& text) {
  std::string line;
  std::getline(text, line);
  std::vector<double> values;
  std::stringstream fields(line);
  for (std::string field; fields >> field;) values.push_back(parse_double(field).value());
  return values;
}

// The taps of PyWavelets are right to some 1e-12; five levels leave 1e-10 of the largest value.
void expect_near(std::span<const double> ours, const std::vector<double>& theirs) {
  EXPECT_THAT(ours, Pointwise(DoubleNear(1e-10 * std::max(1.0, largest(theirs))), theirs));
}

Band rebuilt_with_halved_details(const Case& each, Decomposition parts) {
  Band signal;
  for (std::size_t j = parts.details.size(); j > 0; --j) {
    for (double& value : parts.details[j - 1]) value *= 0.5;
    signal.resize(parts.lengths[j - 1]);
    inverse_dwt(each.wavelet, each.boundary, parts.approximation, parts.details[j - 1], signal);
    parts.approximation = signal;
  }
  return parts.approximation;
}

TEST(PyWavelets, AgreesOnMultilevelTransformsOfRandomLengths) {
  const std::vector<Case> cases = make_cases();
  const TemporaryFolder folder;
  const auto path = folder.path() / "cases.txt";
  write_cases(cases, path);
  const auto [text, code] = output_of("/usr/bin/python3 '" SLIDEWAY_SOURCE_DIR
                                      "/tests/signal/pywavelets_reference.py' '" +
                                      path.string() + "'");
  if (code == 77 || code == 127) GTEST_SKIP() << "no PyWavelets (Debian's python3-pywt)";
  ASSERT_EQ(code, 0);

  std::stringstream answers(text);
  for (const Case& each : cases) {
    SCOPED_TRACE(each.wavelet.name + ' ' + std::string(name(each.boundary)) + " level " +
                 std::to_string(each.level) + " n " + std::to_string(each.signal.size()));
    const Decomposition parts = decompose(each.wavelet, each.boundary, each.level, each.signal);
    expect_near(parts.approximation, next_line(answers));
    for (auto detail = parts.details.rbegin(); detail != parts.details.rend(); ++detail)
      expect_near(*detail, next_line(answers));
    expect_near(rebuilt_with_halved_details(each, parts), next_line(answers));
  }
  EXPECT_EQ(answers.peek(), std::char_traits<char>::eof());
}

}  // namespace
}  // namespace slideway::pywavelets_test
