#pragma once

#include <string>

#include "slideway/trace/plan.hpp"

namespace slideway {

/// A plan for people, in at most 80 columns: the cuts in their order with reasons, then the sets.
std::string plan_text(const Plan& plan);

/// A plan as JSON, schema "slideway.plan/1" (docs/plan.schema.json), two blanks of indent and a
/// final newline.
std::string plan_json(const Plan& plan);

/// A plan as one self-contained page.
std::string plan_page(const Plan& plan);

}  // namespace slideway
