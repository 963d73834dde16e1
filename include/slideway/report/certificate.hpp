#pragma once

#include <string>

#include "slideway/trace/analysis.hpp"

namespace slideway {

/// The final result as a Digital Calibration Certificate: PTB's XML, schema 3.2.0 (namespace
/// https://ptb.de/dcc) with quantities in D-SI 2.1.0 (https://ptb.de/si). It holds E_ZX about each
/// reference line and the squareness, those that are determined, with U, k and coverage
/// probability; conformity as statements; who measured what with which instrument from [about].
/// @throws DataError  [about] lacks what a certificate must have, with all the keys; or nothing is
///                    determined
std::string calibration_certificate(const Analysis& analysis);

}  // namespace slideway
