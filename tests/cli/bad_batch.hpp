#pragma once

#include <span>
#include <string>
#include <vector>

#include "cli/bad_input.hpp"

namespace slideway {

/// A manifest that is refused as a whole.
struct BadManifest {
  std::string name, manifest;
  std::vector<std::string> fragments;  // of the message
  std::vector<std::string> options = {};
};

inline void PrintTo(const BadManifest& bad, std::ostream* out) { *out << bad.name; }

std::span<const BadManifest> bad_manifests();
std::span<const BadUsage> bad_batch_usages();

/// Runs batch on the manifest.
inline ProgramRun run_on(const BadManifest& bad, const TemporaryFolder& folder) {
  folder.file("list.csv", bad.manifest);
  std::vector<std::string> words{"batch", "list.csv", "--out", "out.jsonl"};
  words.insert(words.end(), bad.options.begin(), bad.options.end());
  return run_program(words, {folder.path(), {}});
}

}  // namespace slideway
