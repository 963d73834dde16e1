#pragma once

#include <optional>
#include <string>
#include <vector>

#include "slideway/report/layout.hpp"
#include "slideway/trace/analysis.hpp"

namespace slideway {

inline constexpr std::size_t kBoxText = kLineWidth - 11;  // beside the label of a line of the box

/// How much a verdict asks of who reads it.
enum class Alarm { good, plain, warn, bad };

/// What a report says first, in words: the box of the text, the head of the page.
struct Summary {
  Alarm alarm = Alarm::plain;
  std::string badge;         // the verdict in a word or two
  std::string verdict;       // in a sentence, what harms most first
  std::string straightness;  // "E_ZX 24.4 ± 6.8 µm", or why there is none
  std::string squareness;    // "2.797 ± 0.029 µm/m", or why there is none
  std::string result;        // both, with the definition of E_ZX
  std::string unseen;        // what may have moved it unseen: "by up to 4.1 µm/m: tool wear"
  std::string bent_unseen;   // the same of E_ZX
  std::string same;          // what has the columns of the straightness: "cupped workpiece"
  std::string conformity;    // "flatness conforms", "" without a tolerance
  std::string crosscheck;
  std::string checks;   // both
  std::string missing;  // what was missing and what that had done
  std::string next;
  // In a line of the box, if it can be.
  std::string verdict_in_brief, checks_in_brief, missing_in_brief, next_in_brief;
  bool has_crosscheck = false, has_missing = false, has_next = false;
  bool verdict_names_missing = false;  // what was missing, and what that had done
};

Summary summary_of(const Analysis& analysis);

inline constexpr const char* kNothingToDo = "none is needed for these numbers";
/// What to do now, or kNothingToDo.
std::string next_step(const Analysis& analysis);

/// "a cut at 8 mm/min, by slideway plan; tells cup from thermal drift".
std::string cut_to_make(const NextCut& cut);

/// The most that an effect which is just not seen moves the squareness; "": none is known.
std::string moved_unseen(const Analysis& analysis);
/// The same of E_ZX.
std::string bent_unseen(const Analysis& analysis);

/// ", if no steady drift": of what a value holds unseen (FittedParameter::if_no); "": of nothing.
std::string condition(const std::vector<std::string>& if_no);
/// ", if no cupped workpiece or 2 more".
std::string condition_in_brief(std::vector<std::string> if_no);
/// The same of what a conformity holds, and of a straightness parts_beside().
std::string condition(const Result& result, const Conformity& conformity);

/// ", of C5, the largest of 8, without local form": of several forms whose the straightness is, and
/// parts of E_ZX that the model has under a name of their own, which the value leaves out; "":
/// there are neither. REQUIRES a fit.
std::string parts_beside(const Result& result);

/// Whether what the loop has added moved no declared number worth an alarm. REQUIRES a loop.
bool is_harmless(const Analysis& analysis);

/// Whether a check speaks against the model.
bool contradicts(const ProfileCheck& check);

/// Whether U exceeds what a check compares, so that it shows little.
bool shows_little(const SquarenessCheck& check);
bool shows_little(const ProfileCheck& check);

/// Whether repeats share far more than one reading differs from the next, and it is no lack of fit:
/// a texture of the surface.
bool is_texture(const PureErrorCheck& check);

/// What the model explains the profiles down to: "noise".
std::string noise_of(const Crosscheck& checks);

/// Whether the run-out, two profiles or one that was held out speak against the model.
bool is_contradicted(const Crosscheck& checks);

/// What speaks against the numbers: they break a tolerance or disagree with a check.
std::vector<std::string> objections(const Result& result);

void say_crosscheck(const Result& result, Summary& out);

/// "33.0 ± 5.4 and 35.4 ± 5.5 µm": what each profile says by itself, or "".
std::string each_alone(const ProfileCheck& check);

/// Whether it is of all profiles taken together, not of two.
bool is_of_all(const ProfileCheck& check);

/// "run2 and run3", or "all profiles".
std::string who_of(const ProfileCheck& check);
bool contradicts(const HeldOutCheck& check);

/// An effect's plain name; "unnamed" is "something without a name".
std::string effect_title(const std::string& name);
// An accepted effect, with the profiles it is confined to, and its rivals.
std::vector<std::string> names_of(const TraceRound& round);
std::string effect_titles(const std::vector<std::string>& names, const std::string& separator);
/// "straightness.b2" with its symbol: "straightness b_2".
std::string parameter_title(const FittedParameter& parameter);
/// A sentence of the program with the effects of the catalogue named for people.
std::string with_titles(std::string text);

/// Whether a parameter is the squareness of the X carriage to the spindle.
bool is_squareness(const FittedParameter& parameter);
/// Whether an effect is the pitch that the form of the vertical guideway makes.
bool is_vertical(const std::string& effect);

/// "the slide coordinate", of a variable that several profiles share; "" if it is none.
std::string variable_of(const Unnamed& left);
/// What has no name, as a curve over a variable or in a profile: "a curve in cut3 alone".
std::string likeness(const Unnamed& left);

/// With a capital and a full stop.
std::string in_sentence(std::string text);

/// What a key was taken as, the same before a report was written and after.
std::string value_of(const Assumption& assumption);

/// The declared quantity that the missing effects had moved most.
struct Shift {
  std::string what;  // for people
  double in_expanded_uncertainties =
      0.0;  // declared minus final, in expanded uncertainties of the final
};

/// None where the loop has added nothing or nothing can be compared.
std::optional<Shift> largest_shift(const Result& result);

/// True if the loop has added effects to the declared model.
bool was_extended(const Analysis& analysis);

/// "0.2 -> 0.05 µm", "" where one of the two is not known.
std::string residual_change(const std::optional<double>& before_um,
                            const std::optional<double>& after_um,
                            const std::optional<double>& before_urad,
                            const std::optional<double>& after_urad);

}  // namespace slideway
