#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Text and numbers, the same in every locale.
namespace slideway {

/// The value of a whole field, correctly rounded; blanks around it and a leading '+' are allowed.
/// Nothing if the field is empty, is not a number, or lies outside the range of double. "nan" and
/// "inf" are numbers here.
std::optional<double> parse_double(std::string_view field);

/// Shortest text that reads back as the same double, with '.' as decimal point.
std::string shortest(double value);

/// `value` with `digits` significant digits, as printf's %.*g but without an exponent from 1 to
/// 1e6.
std::string significant(double value, int digits);

std::string_view trimmed(std::string_view text);

/// "a, b, c"
std::string joined(std::span<const std::string> words, std::string_view separator = ", ");

/// "1 row", "2 rows".
std::string counted(std::size_t count, const std::string& singular);

/// Two lower-case digits per byte: "0fbf".
std::string hexadecimal(std::span<const unsigned char> bytes);

/// Text from outside, safe for a one-line message: its first `limit` characters, "..." if it is
/// longer, and '?' for control characters (C0, C1, writing direction) and for invalid UTF-8.
std::string printable(std::string_view text, std::size_t limit = 24);

/// A name of the problem file as words: "tool_wear" is "tool wear".
std::string in_words(std::string name);

/// " (did you mean 'squareness'?)" for the accepted word nearest to a mistyped one, or "" if none
/// is near (edit distance above a third of the word's length, capital letters aside).
std::string did_you_mean(std::string_view word, std::span<const std::string> accepted);

}  // namespace slideway
