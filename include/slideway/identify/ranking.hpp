#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "slideway/identify/fit.hpp"
#include "slideway/identify/result.hpp"

namespace slideway {

/// Correlates what each effect of a fitted model puts into each profile with the profile itself,
/// before and after the low band: Eqs. (6), (19), (20) and Figs. 8, 9.
///
/// The signal of an effect is that of the fit; where that is rounding beside the profile (a
/// squareness levelled away) and it has one amplitude, its shape alone; with more amplitudes
/// nothing.
RankingResult rank_effects(const Model& model, const Solution& fit);

/// The effect whose |low-band coefficient|, averaged over the profiles, is largest, and the one
/// with the largest share of the fitted low band, with a doubt where the lead is small or where the
/// data do not tell the effect from another.
Dominant dominant_effects(const RankingResult& ranking, const ModelResult& fit);

/// One column held against the signal's column.
struct ColumnRanking {
  std::string candidate;
  double raw = 0.0, low_band = 0.0;
  int lag = 0;  // rows, of the largest |coefficient|
  double lag_coefficient = 0.0;
  double effective_observations = 0.0;
  double p_value = 1.0;
};

/// Ranks named columns against a signal of as many rows (Fig. 11), largest |low-band coefficient|
/// first. REQUIRES finite values.
/// @throws DataError  too few rows for the low band
std::vector<ColumnRanking> rank_columns(
    const std::vector<double>& signal,
    const std::vector<std::pair<std::string, std::vector<double>>>& candidates,
    const LowBandOptions& options);

/// The same of columns of a table. @throws DataError, UsageError
std::vector<ColumnRanking> rank_columns(const std::filesystem::path& file,
                                        const std::string& signal,
                                        const std::vector<std::string>& candidates,
                                        const LowBandOptions& options);

}  // namespace slideway
