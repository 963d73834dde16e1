#pragma once

#include <vector>

#include "slideway/identify/fit.hpp"
#include "slideway/trace/trace.hpp"

namespace slideway {

/// For every two fitted readings along the slide, of different declared surfaces and by one
/// instrument: what their residuals share at the same positions.
///
/// Both residuals are put on one grid over their common travel. With a_j, b_j their cosine
/// coefficients beyond those the model takes, n_k of them in octave k, and r_k their correlation
/// there, the statistic is the gain in log likelihood of a common part in every octave,
///   T = Σ_k max(0, sign r_k) · (-n_k/2) ln(1 - r_k²).
/// Under the null hypothesis the coefficients are independent, with one variance in an octave: the
/// distribution of T, whatever the spectra, is drawn from normal numbers. The gate `significance`
/// is shared by all pairs.
///
/// What the instrument adds is in every further surface c that it has read. With m_j = (a_j +
/// b_j)/2 the mean of d_j = c_j m_j - a_j b_j, scaled to one size in every octave, is then 0; a
/// surface lacks it where Student's t of that mean is as low as chance makes it more rarely than
/// `instrument_doubt`, which all further surfaces share.
std::vector<SharedResidual> shared_residuals(const FittedModel& fitted);

/// Names what is significant among out.instrument: a round `instrument`, and the rival of every
/// accepted effect that acts in such a profile. Where nothing is, what chance makes more rarely
/// than Gates::instrument_doubt: with no name as its rival; and so if a further surface lacks all
/// that is significant.
void name_instrument(const Gates& gates, TraceResult& out);

}  // namespace slideway
