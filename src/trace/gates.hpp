#pragma once

/// What a candidate must bring to enter the model (accept or refuse).
namespace slideway {

inline constexpr double kEnough = 10.0;         // -ΔBIC of adding it
inline constexpr double kTied = 10.0;           // of BIC: no choice between two within it
inline constexpr double kLeastSize = 5.0;       // standard uncertainties of its own size
inline constexpr double kLeastJointSize = 3.0;  // the same in the joint fit

}  // namespace slideway
