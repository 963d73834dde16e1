#include "slideway/identify/gates.hpp"

#include <array>

namespace slideway {

std::span<const Gate> gate_table() {
  static constexpr std::array kGates{
      Gate{
          "significance", &Gates::significance, "", 1e-6, 0.2,
          "An effect enters if the whole search finds as much in noise with a smaller probability.",
          "one false alarm in a hundred problems"},
      Gate{"delta_bic", &Gates::delta_bic, "", 2.0, 30.0,
           "An effect enters if it lowers the BIC by this much, and stays only so.",
           "Kass and Raftery (1995): above 10 the evidence is very strong"},
      Gate{"size", &Gates::size, "standard uncertainties", 3.0, 10.0,
           "An effect enters if its size is this many of its standard uncertainties.",
           "5: the convention for a discovery; a search over many shapes makes 3 common"},
      Gate{"tie_bic", &Gates::tie_bic, "", 2.0, 30.0,
           "Two effects within this difference of BIC are rivals: no choice is made.",
           "Kass and Raftery (1995), as delta_bic"},
      Gate{"exchange_bic", &Gates::exchange_bic, "", 0.0, 10.0,
           "A better effect takes the place of an accepted one from this difference of BIC on.",
           "Kass and Raftery (1995): below 2 the evidence is not worth a mention"},
      Gate{"alike", &Gates::alike, "", 0.1, 0.9,
           "Two effects explain the same part of the residual if the cosine between their parts "
           "is larger.",
           "two independent parts of 50 values reach 0.3 with a probability of 3 %"},
      Gate{"holdout_share", &Gates::holdout_share, "", 0.01, 0.5,
           "A profile is predicted from the others if they hold this share of what all know of "
           "the effect.",
           "below a tenth the prediction is three times as uncertain as the effect"},
      Gate{"lack_of_fit_p", &Gates::lack_of_fit_p, "", 1e-6, 0.05,
           "The residual is structure if noise explains it with a smaller probability.",
           "one false alarm in a thousand problems"},
      Gate{"lack_of_fit_ratio", &Gates::lack_of_fit_ratio, "", 1.0, 10.0,
           "The residual is structure if its slow part has this many times the expected square.",
           "a factor of two in the square widens U by less than the estimate of the noise does"},
      Gate{"noise_extrapolation", &Gates::noise_extrapolation, "", 0.0, 1.0,
           "Relative standard uncertainty of the noise below the band it is measured in.",
           "bench/quality, 300 clean faces: p < 0.05 in 5.7 %; with 0 in 16 %"},
      Gate{"slow_cosines", &Gates::slow_cosines, "", 4.0, 48.0,
           "So many slow cosines of a profile are left free when its noise is estimated.",
           "8 cycles a profile: the carriage's form and slow effects lie below"},
      Gate{"values_per_cosine", &Gates::values_per_cosine, "low-band values", 4.0, 40.0,
           "Short profiles leave fewer cosines free: one for so many values.",
           "nine tenths of the values remain to estimate the noise from"},
      Gate{"values_for_memory", &Gates::values_for_memory, "low-band values", 10.0, 200.0,
           "With fewer values beyond the free parameters noise is taken as white.",
           "with 40 values an autocorrelation has a standard uncertainty of 0.16"},
      Gate{"longest_memory", &Gates::longest_memory, "trace lengths", 1.0, 100.0,
           "Longest memory of the noise.",
           "at 4 a slope is within 5 % of its uncertainty under a random walk"},
      Gate{"noise_likeness", &Gates::noise_likeness, "", 0.05, 5.0,
           "Standard deviation of ln(size of the noise) between profiles that share its memory.",
           "cuts by one tool differ by a factor of 1.6; a hundred values outweigh it"},
      Gate{"unlike_noise", &Gates::unlike_noise, "", 1.5, 100.0,
           "A profile whose noise is so many times that of its sisters, or so small a part, "
           "differs.",
           "a factor of 2 is within what cuts by one tool show, of 4 it is not"},
      Gate{"declared_noise_bic", &Gates::declared_noise_bic, "", 2.0, 30.0,
           "A declared standard uncertainty is overruled if the residual refutes it by this much.",
           "Kass and Raftery (1995), as delta_bic"},
      Gate{"false_line", &Gates::false_line, "", 1e-6, 0.05,
           "Probability that noise alone is given a spectral line, which is then taken out of it.",
           "the spectrum of noise over its local level is exponential"},
      Gate{"most_lines", &Gates::most_lines, "", 0.0, 48.0,
           "Most lines taken out of the noise of one profile.",
           "feed marks have 6 harmonics above the noise of problems/real, each on two halves"},
      Gate{"nose_radius_mm", &Gates::nose_radius_mm, "mm", 0.05, 20.0,
           "Nose radius of the tool where [[profile]] does not give it.",
           "ISO 6987: inserts for turning have 0.2 to 2.4 mm; a large one leaves out more"},
      Gate{"most_lost", &Gates::most_lost, "of the radius", 0.0, 0.5,
           "Largest part of a face left out at its centre because the nose cannot follow.",
           "an effect steep further out is not one of the centre"},
      Gate{"rank_tolerance", &Gates::rank_tolerance, "of a unit column", 1e-13, 1e-4,
           "A combination of parameters is not determined if it moves the model less than this.",
           "columns carry rounding of about 1e-15, and shapes of 1e-12"},
      Gate{"resamples", &Gates::resamples, "", 19.0, 999.0,
           "Resamples of the noise from which the false-alarm probability is found.",
           "99: the Gumbel tail through their mean and variance is within 15 % at p = 0.01"},
      Gate{"detection_power", &Gates::detection_power, "", 0.5, 0.99,
           "Probability with which an effect of the size of its detection limit is found.",
           "0.8: the convention of power analysis (Cohen 1988)"}};
  return kGates;
}

}  // namespace slideway
