/// \file
/// The rule that decided a corner's verdict, to trace a missed or false rebel to its cause.
///
/// A corner passes several tests in a row; the reason is the deciding test. In the paper's filter
/// several edges or rows of alpha may reject a corner: the reason comes from the edge or row that
/// passed the most tests, in the order of declaration.
#pragma once

#include <array>
#include <cstdint>

namespace lcs {

enum class Reason : std::uint8_t {
  unknown,  // The detector gives no reasons.

  // Both filters.
  not_finite,
  outside,
  too_many,
  in_psi,
  no_time,
  normal_edge,
  rebel_edge,

  // The default filter: the corner's neighbours outvoted its own track (MODEL.md (18)).
  normal_neighbours,
  rebel_neighbours,

  // The default filter: the corner has a track that moves as a static point does.
  comer,
  goer,

  // The default filter: the corner has no track with a motion.
  inherited,
  first_sighting,

  // The paper's filter: no edge took the corner. It starts a row of alpha,
  alpha_first,
  xi_5,
  xi_4,
  outbid,
  // or belongs to a normal edge's layer,
  xi_1,
  // or continues a row of alpha,
  alpha_second,
  alpha_bend,
  alpha_on_field,
  alpha_taken,
  alpha_third,
  // or a normal edge took it.
  xi_3,
  xi_2,
};

struct ReasonText {
  const char* word;     ///< in files
  const char* meaning;  ///< human-readable, printed after a share of corners
};

/// In the order of `Reason`, each with the verdict that it implies.
inline constexpr std::array<ReasonText, 26> kReasons{{
    {"unknown", "no reason given"},
    {"not_finite", "its place is not a number"},                                         // pending
    {"outside", "outside of the picture"},                                               // pending
    {"too_many", "farther out than the most corners that are looked at"},                // pending
    {"in_psi", "inside a region psi that was not looked at"},                            // ignored
    {"no_time", "no time has passed since the frame before"},                            // pending
    {"normal_edge", "its track moved as a static point may"},                            // normal
    {"rebel_edge", "its track moved as no static point does"},                           // rebel
    {"normal_neighbours", "its track spoke for a rebel, but none near it moves alike"},  // normal
    {"rebel_neighbours", "its track was in doubt, and rebels near it move alike"},       // rebel
    {"comer", "of a body that floats above the ground, as one does that approaches"},    // rebel
    {"goer", "of a body that stands on rebels below the ground's bound"},                // rebel
    {"inherited", "likely a rebel by those round it"},                                   // rebel
    {"first_sighting", "in no frame before, and not among rebels"},                      // pending
    {"alpha_first", "near no edge and on no row of alpha: starts one"},                  // pending
    {"xi_5", "outside the span of the edges near it: starts a row of alpha"},            // pending
    {"xi_4", "against the field or too fast for it: starts a row of alpha"},             // pending
    {"outbid", "fits an edge that took a better corner: starts a row of alpha"},         // pending
    {"xi_1", "a further corner of a normal edge's layer, outside its radius mu"},        // pending
    {"alpha_second", "second of a row of alpha, third of none"},                         // pending
    {"alpha_bend", "broke a row of alpha at its third: off the line (deviation)"},       // pending
    {"alpha_on_field", "broke a row of alpha at its third: static points may move so"},  // pending
    {"alpha_taken", "third of a row of alpha that took a better corner"},                // pending
    {"alpha_third", "third of a row of alpha: a new rebel edge"},                        // rebel
    {"xi_3", "taken by a normal edge, short of its prediction"},                         // normal
    {"xi_2", "taken by a normal edge, at its prediction or beyond"},                     // normal
}};
static_assert(kReasons.size() == static_cast<std::size_t>(Reason::xi_2) + 1);

constexpr const ReasonText& text_of(Reason reason) {
  return kReasons[static_cast<std::size_t>(reason)];
}

}  // namespace lcs
