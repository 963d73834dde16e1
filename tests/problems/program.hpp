#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "problems/shipped.hpp"
#include "slideway/base/file.hpp"

namespace slideway {

/// What the program writes to stdout, run at the root of the sources.
inline std::string output_of(const std::string& arguments) {
  const std::string command =
      "cd '" + source_folder().string() + "' && '" + SLIDEWAY_PROGRAM + "' " + arguments;
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("popen: " + command);
  std::string text;
  std::array<char, 4096> part{};
  while (const std::size_t n = std::fread(part.data(), 1, part.size(), pipe))
    text.append(part.data(), n);
  if (::pclose(pipe) != 0) throw std::runtime_error("failed: " + command);
  return text;
}

/// A document whose contents come from the program is up to date; with SLIDEWAY_UPDATE=1 in the
/// environment it is brought up to date.
inline void expect_current(const std::filesystem::path& document, const std::string& text) {
  const std::string shipped(FileBytes(document).text());
  if (shipped == text) return;
  if (std::getenv("SLIDEWAY_UPDATE") != nullptr) return write_file(document, text);
  std::size_t line = 1, i = 0;
  for (; i < std::min(shipped.size(), text.size()) && shipped[i] == text[i]; ++i)
    line += shipped[i] == '\n';
  ADD_FAILURE() << document.string() << ":" << line
                << ": not what the program says today. If the change is meant, run\n"
                   "  SLIDEWAY_UPDATE=1 ctest -R problems/Documents\nand commit the file.";
}

}  // namespace slideway
