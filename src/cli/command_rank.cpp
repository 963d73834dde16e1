#include <memory>
#include <nlohmann/json.hpp>

#include "low_band_arguments.hpp"
#include "output.hpp"
#include "report_command.hpp"
#include "slideway/base/text.hpp"
#include "slideway/identify/ranking.hpp"
#include "slideway/report/layout.hpp"
#include "slideway/report/number.hpp"
#include "slideway/report/report.hpp"

namespace slideway {
namespace {
namespace po = boost::program_options;

class RankCommand : public ProblemCommand {
 public:
  RankCommand()
      : ProblemCommand("rank", "PROBLEM | FILE.csv --signal COL --candidates COL... [options]",
                       "Correlates each declared effect, or any columns, with the signal") {
    add_options()("signal", po::value(&signal_)->value_name("COL"),
                  "rank columns of a file against this one: header name or number");
    add_options()("candidates", po::value(&candidates_)->value_name("COL...")->multitoken(),
                  "the columns to rank");
    low_band_.add_to(add_options());
  }

  int run() override { return signal_.empty() ? run_problem(Scope::rank) : run_columns(); }

 private:
  void check(const po::variables_map& given) override {
    ProblemCommand::check(given);
    if (input().empty() && !candidates_.empty())
      fail("FILE.csv is missing; put it first, --candidates takes every word behind it");
    options_ = low_band_.checked(0);
    if (!signal_.empty()) {
      if (candidates_.empty()) fail("--candidates COL... is missing");
      if (given.count("data") != 0) fail("--data belongs to a PROBLEM, not to --signal");
      return;
    }
    for (const char* option : {"signal", "candidates", "wavelet", "level", "boundary"})
      if (given.count(option) != 0 && !given[option].defaulted())
        fail(std::string("--") + option + " needs --signal COL; a problem file has [low_band]");
  }

  int run_columns() const {
    keep(input());
    const std::vector<ColumnRanking> ranking =
        rank_columns(input(), signal_, candidates_, options_);
    report([&] { return text(ranking); }, [&] { return json(ranking); },
           [&] { return html_report(json(ranking), input()); });
    return kDone;
  }

  [[nodiscard]] std::string text(const std::vector<ColumnRanking>& ranking) const {
    constexpr auto kText = TextColumn::name, kNumber = TextColumn::number;
    const bool filtered = options_.level > 0;
    std::vector<std::string> headings{"candidate", "raw", "lag", "at lag", "N_eff", "p"};
    std::vector<TextColumn> columns{kText, kNumber, kNumber, kNumber, kNumber, kNumber};
    if (filtered) {
      headings.insert(headings.begin() + 2, "low band");
      columns.push_back(kNumber);
    }
    TextTable table(headings, columns);
    for (const ColumnRanking& row : ranking) {
      std::vector<std::string> cells{row.candidate, fixed_point(row.raw, 3)};
      if (filtered) cells.push_back(fixed_point(row.low_band, 3));
      cells.insert(cells.end(), {std::to_string(row.lag), fixed_point(row.lag_coefficient, 3),
                                 fixed_point(row.effective_observations, 0),
                                 row.p_value < 1e-300 ? "< 1e-300" : significant(row.p_value, 2)});
      table.add(std::move(cells));
    }
    return "Correlation with column '" + signal_ + "' of " + input() + "\nLow band: " +
           (options_.level == 0 ? "none"
                                : options_.wavelet + ", level " + std::to_string(options_.level) +
                                      ", " + std::string(slideway::name(options_.boundary))) +
           "\n\n" + table.text();
  }

  [[nodiscard]] std::string json(const std::vector<ColumnRanking>& ranking) const {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const ColumnRanking& row : ranking)
      rows.push_back({{"candidate", row.candidate},
                      {"raw", row.raw},
                      {"low_band", row.low_band},
                      {"lag", row.lag},
                      {"lag_coefficient", row.lag_coefficient},
                      {"effective_observations", row.effective_observations},
                      {"p_value", written_probability(row.p_value)}});
    const nlohmann::ordered_json document = {{"schema", "slideway.columns/1"},
                                             {"file", input()},
                                             {"signal", signal_},
                                             {"low_band",
                                              {{"wavelet", options_.wavelet},
                                               {"level", options_.level},
                                               {"boundary", slideway::name(options_.boundary)}}},
                                             {"ranking", rows}};
    return document_text(document);
  }

  std::string signal_;
  std::vector<std::string> candidates_;
  LowBandArguments low_band_{{"db1", 0, Boundary::symmetric}};
  LowBandOptions options_;
};

}  // namespace

std::unique_ptr<Command> make_rank() { return std::make_unique<RankCommand>(); }

}  // namespace slideway
