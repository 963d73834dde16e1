#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "slideway/identify/fit.hpp"
#include "slideway/identify/result.hpp"

namespace slideway {

/// Correlates what each effect of a fitted model puts into each profile with the profile itself,
/// before and after the low band: Eqs. (6), (19), (20) and Figs. 8, 9.
///
/// What is free in a profile (offset, tilt) is taken out of both by least squares first: a tilt
/// that levelling left would count as form. Where nothing is free the raw coefficient is the
/// paper's.
///
/// The signal of an effect is that of the fit; where that is rounding beside the profile (a
/// squareness levelled away) and it has one amplitude, its shape alone; with more amplitudes
/// nothing.
RankingResult rank_effects(const Model& model, const Solution& fit);

/// The two effects with the largest shares of what the fit puts into the low band, levelled: the
/// mean square of one over the sum of all, averaged over the fitted profiles that see two or more.
struct LeadByFit {
  std::string first, second;
  double share = 0.0, next = 0.0;
  double expanded_uncertainty = 0.0;  // of share - next, from the covariance of the amplitudes; 1
                                      // at most
};

/// None where the model has fewer than two effects that the fitted profiles can see.
std::optional<LeadByFit> lead_by_fit(const Model& model, const Solution& fit);

/// By correlation: the effect whose |low-band coefficient|, averaged over the profiles that see two
/// effects or more, is significant and clearly the largest. By fit: the one with the larger share,
/// if it is larger by more than its expanded uncertainty and not by a convention; else the doubt
/// says why there is none.
Dominant dominant_effects(const RankingResult& ranking, const std::optional<LeadByFit>& fit,
                          const Identifiability& identifiability, const Gates& gates = {});

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
