#pragma once

#include <Eigen/Core>
#include <vector>

#include "slideway/identify/gates.hpp"
#include "slideway/identify/noise.hpp"
#include "slideway/identify/solve.hpp"

namespace slideway {

/// The noise of every fitted profile beside what a model may lack, by restricted maximum
/// likelihood: a missing effect is not taken for noise. The estimate is made from what is faster
/// than a band of slow cosines, which is left free; columns of the model as slow as that are left
/// free with it. Other columns, and lines that stand out of the spectrum, are taken out of the
/// residual first. A profile with too few values for that is estimated from its whole residual, the
/// model left free.
///
/// @param linear   the model at its estimate
/// @param suspect  per fitted observation: low-band columns of an effect under suspicion, or none
std::vector<Noise> noise_beside(const Linearisation& linear, const Gates& gates,
                                std::vector<Eigen::MatrixXd> suspect = {});

/// Of the noises that noise_beside() allows, each is no more probable, beside the likeliest, than
/// the whole residuals make it, the model and the suspect left free: the fine band shows nothing of
/// what is slow. None becomes more probable, for what the model lacks is no noise.
/// @param suspect  as there
void rule_out_by_whole(const Linearisation& linear, const Gates& gates,
                       const std::vector<Eigen::MatrixXd>& suspect, std::vector<Noise>& noise);

/// noise_beside() what a profile may lack, each profile fitted by itself: what profiles disagree by
/// is in the noise of none of them. They share their memory as in a joint fit.
/// @param joint  of the fit of all: the answer where the model has a curve, which would take all of
///               a profile that is alone
std::vector<Noise> noise_of_each(const Linearisation& linear, const std::vector<Noise>& joint,
                                 const Gates& gates);

/// The noise a model is fitted under.
struct FitNoise {
  std::vector<Noise> profiles;  // per fitted observation
  double inflation = 1.0;       // of all variances, for structure the model lacks
};

/// The noise of every fitted profile if the model is complete: from the whole residual, the model
/// left free.
/// @param beside  noise_beside(): how repeats weigh is taken from it
std::vector<Noise> noise_if_complete(const Linearisation& linear, std::vector<Noise> beside,
                                     const Gates& gates);

/// The noise of every fitted profile under the model, by restricted maximum likelihood.
///
/// From the whole residual, the model left free, if the slow band holds no more than noise
/// (lack_of_fit()). Else it is noise_beside() the structure, and variances are inflated by the
/// slow band's square over what that noise leaves there (Birge 1932): structure is not taken for
/// a long memory of the noise, which would move the estimate, but uncertainties allow for it.
FitNoise noise_under(const Linearisation& linear, const Gates& gates);

/// White noise of the declared size, or of the size of the values after levelling: what a fit
/// begins with.
std::vector<Noise> first_noise(const Model& model);

/// cos(π j (i + 1/2) / n), j = 1 ... count: the slow band, n by count.
Eigen::MatrixXd slow_cosines(Eigen::Index n, Eigen::Index count);

/// How many of them a profile of n values is given.
Eigen::Index slow_cosine_count(Eigen::Index n, const Gates& gates);

}  // namespace slideway
