#pragma once

#include "slideway/base/record.hpp"
#include "slideway/trace/plan.hpp"

/// Members of a plan: schema "slideway.plan/1".
namespace slideway {

template <>
inline constexpr auto kRecord<PlannedCutSummary> = record(
    "PlannedCut", "A cut or trace that was tried on paper.",
    field("name", &PlannedCutSummary::name), field("what", &PlannedCutSummary::what),
    field("like", &PlannedCutSummary::like, "the profile it differs from in that; empty: none"),
    field("cost", &PlannedCutSummary::cost), field("time_min", &PlannedCutSummary::time_min));

template <>
inline constexpr auto kRecord<PlannedQuantity> =
    record("PlannedQuantity", "Expanded uncertainty of a wanted quantity.",
           field("name", &PlannedQuantity::name), field("symbol", &PlannedQuantity::symbol),
           field("unit", &PlannedQuantity::unit),
           field("U_now", &PlannedQuantity::U_now, "none: not determined"),
           field("U_planned", &PlannedQuantity::U_planned, "none: not determined"));

template <>
inline constexpr auto kRecord<PlannedLimit> =
    record("PlannedLimit", "Detection limit of an effect.", field("effect", &PlannedLimit::effect),
           field("parameter", &PlannedLimit::parameter), field("unit", &PlannedLimit::unit),
           field("at", &PlannedLimit::at, "its shapes"),
           field("same_as", &PlannedLimit::same_as, "parameters that hide it now"),
           field("now", &PlannedLimit::now, "none: found at no size"),
           field("planned", &PlannedLimit::planned, "none: found at no size"));

template <>
inline constexpr auto kRecord<PlannedPair> =
    record("PlannedPair", "Two effects that the present profiles do not tell apart.",
           field("effect", &PlannedPair::effect), field("rival", &PlannedPair::rival),
           field("now", &PlannedPair::now,
                 "size told from the rival, in detection limits of today; none: no size"),
           field("planned", &PlannedPair::planned, "the same with the cuts"),
           field("told_apart", &PlannedPair::told_apart, "planned is at most planned_size"));

template <>
inline constexpr auto kRecord<PlannedDesign> = record(
    "PlannedDesign", "Some cuts and what they bring.", field("cuts", &PlannedDesign::cuts),
    field("criteria", &PlannedDesign::criteria, "by which a set is the best of its size: D, A"),
    field("reason", &PlannedDesign::reason),
    field("score", &PlannedDesign::score, "the order of the plan"),
    field("d_gain", &PlannedDesign::d_gain, "mean logarithm of what U falls by, by determinants"),
    field("a_share", &PlannedDesign::a_share, "mean of (u planned / u now)²"),
    field("cost", &PlannedDesign::cost), field("time_min", &PlannedDesign::time_min),
    field("quantities", &PlannedDesign::quantities), field("limits", &PlannedDesign::limits),
    field("pairs", &PlannedDesign::pairs),
    field("testable", &PlannedDesign::testable, "effects that cannot be looked for now"));

template <>
inline constexpr auto kRecord<Plan> =
    record("Plan", "Which cut or trace to make next.", field("schema", &Plan::schema),
           field("version", &Plan::version), field("title", &Plan::title),
           field("cuts", &Plan::cuts), field("alone", &Plan::alone, "each cut, best first"),
           field("sets", &Plan::sets, "of two and of three"), field("notes", &Plan::notes));

}  // namespace slideway
