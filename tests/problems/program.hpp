#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>

#include "cli/run_program.hpp"
#include "problems/shipped.hpp"
#include "slideway/base/file.hpp"

namespace slideway {

/// What the program writes to stdout, run at the root of the sources.
inline std::string output_of(const std::string& arguments) {
  std::istringstream words(arguments);
  const ProgramRun run =
      run_program({std::istream_iterator<std::string>(words), {}}, {source_folder(), {}});
  if (run.exit_code != 0) throw std::runtime_error(arguments + ": failed: " + run.err);
  return run.out;
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
                   "  SLIDEWAY_UPDATE=1 ctest -R Documents\nand commit the file.";
}

}  // namespace slideway
