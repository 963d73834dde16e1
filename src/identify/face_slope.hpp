#pragma once

#include "slideway/identify/model.hpp"
#include "slideway/identify/solve.hpp"

namespace slideway {

/// z'(r) of the face that the errors of the carriages make in the first fitted profile which
/// crosses the spindle axis; null where none does.
std::shared_ptr<const FaceSlope> face_slope(const Model& model, const Estimate& estimate);

/// How z'_rms of that face changes with the amplitudes of the model: 1 by #amplitudes.
Eigen::RowVectorXd rms_slope_by_amplitude(const Model& model, const Estimate& estimate);

/// Makes anew the effects whose form is that of the face, with the slope of the model's range.
/// @return  whether there are any
bool follow_face(Model& model);

}  // namespace slideway
