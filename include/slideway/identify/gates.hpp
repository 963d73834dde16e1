#pragma once

#include <span>
#include <string_view>

/// The numbers that decide what slideway says, each a key of [trace].
namespace slideway {

/// A verdict hangs on comparisons with these. Every one has a name, a unit, a default, a range
/// and a source: gate_table(), `slideway help trace`.
struct Gates {
  // What a candidate must bring.
  double significance = 0.01;
  double instrument_doubt = 0.05;
  double delta_bic = 10.0;
  double size = 5.0;
  double tie_bic = 10.0;
  double tie_share = 1e-3;
  double wave_share = 5e-3;
  double exchange_bic = 2.0;
  double left_over_bic = 30.0;
  double alike = 0.3;
  double holdout_share = 0.1;
  double modulation_widths = 5.0;
  double modulation_share = 0.1;
  double feed_harmonics = 16.0;
  double folded_widths = 2.0;
  double values_per_cycle = 4.0;

  // What a name must be better than.
  double process_margin = 0.0;
  double local_form_margin = 0.0;
  double unnamed_tie = 5.0;
  double stable_share = 0.8;
  double most_forms = 3.0;
  double form_share = 0.5;

  // When the residual is structure.
  double lack_of_fit_p = 1e-3;
  double lack_of_fit_ratio = 2.0;
  double noise_extrapolation = 0.25;

  // The noise.
  double slow_cosines = 16.0;
  double values_per_cosine = 10.0;
  double values_for_memory = 40.0;
  double memory_odds = 4.0;
  double longest_memory = 4.0;
  double longest_texture = 0.125;
  double noise_likeness = 0.5;
  double unlike_noise = 4.0;
  double declared_noise_bic = 10.0;
  double false_line = 1e-3;
  double most_lines = 12.0;

  // When profiles agree.
  double en_limit = 1.0;
  double false_disagreement = 0.0455;
  double held_out_p = 0.01;
  double disagreement_p = 1e-4;
  double shared_evidence = 10.0;
  double profiles_for_slow_noise = 3.0;
  double same_place = 0.25;
  double values_per_repeated_cosine = 3.0;
  double blunder_bic = 20.0;
  double blunder_rival = 0.5;
  double blunder_left = 0.1;
  double sister_factor = 2.0;
  double most_blocks = 40.0;
  double least_blocks = 5.0;

  // What is left out of a face.
  double nose_radius_mm = 2.0;
  double most_lost = 0.1;
  double one_rim = 5.0;

  // What can be determined, and how the search is carried out.
  double rank_tolerance = 1e-9;
  double resamples = 99.0;
  double detection_power = 0.8;
  double search_values = 2048.0;
  double refine_bic = 30.0;
  double refine_share = 0.6;
  double most_refined = 12.0;
  double rival_reach = 4.0;
  double planned_size = 3.0;
  double tried_changes = 4.0;
  double noise_spread = 1.0;

  // What is said beside the verdict.
  double most_hidden = 3.0;
  double drift_bend = 0.3;
  double nearly_alike = 0.95;
  double ranking_p = 0.05;
  double ranking_lead = 0.8;
  double listed_correlation = 0.1;
  double most_straightness = 10.0;
  double most_of_range = 100.0;
  double absorbed_share = 0.02;
  double harmless_shift = 0.1;
};

/// One gate, as the problem file and the help have it.
struct Gate {
  std::string_view name;  // the key of [trace]
  double Gates::*value;
  std::string_view unit;     // "" for a plain number
  double lower, upper;       // range in which a value is accepted
  std::string_view decides;  // in a sentence
  std::string_view source;   // table, theorem or measurement
};

/// All gates, in the order of `slideway help trace`.
std::span<const Gate> gate_table();

}  // namespace slideway
