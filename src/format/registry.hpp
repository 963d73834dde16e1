#pragma once

#include "slideway/format/format.hpp"

namespace slideway {

const Format& x3p_format();
const Format& sdf_format();
const Format& smd_format();
const Format& prf_format();
const Format& nist_xml_format();

}  // namespace slideway
