#pragma once

#include <string>

namespace slideway {

/// A key that the problem file leaves out although it decides what is found, and what it is taken
/// as.
struct Assumption {
  std::string key;    // "profile.feed2.free"
  std::string value;  // as TOML and JSON write it: ["offset", "tilt"]; "" until the data are read
  std::string why;    // "default"; "largest radius of the trace"
};

}  // namespace slideway
