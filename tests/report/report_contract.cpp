#include <iostream>
#include <string>

#include "slideway/base/file.hpp"
#include "slideway/report/contract.hpp"

/// report_contract --check|--update SOURCE: whether the published files are those that the lists of
/// members make today; or writes them.
int main(int argc, char** argv) {
  const std::string job = argc == 3 ? argv[1] : "";
  if (job != "--check" && job != "--update") {
    std::cerr << "usage: report_contract --check|--update SOURCE\n";
    return 2;
  }
  const std::filesystem::path source = argv[2];
  int differing = 0;
  for (const auto& [name, text] :
       {std::pair("docs/report.schema.json", slideway::report_schema()),
        std::pair("docs/brief.schema.json", slideway::brief_schema()),
        std::pair("docs/plan.schema.json", slideway::plan_schema()),
        std::pair("src/python/slideway/report.py", slideway::report_classes())}) {
    const std::filesystem::path file = source / name;
    if (job == "--update") {
      slideway::write_file(file, text);
    } else if (!std::filesystem::exists(file) || slideway::FileBytes(file).text() != text) {
      std::cerr << name << " is not what the program makes; report_contract --update " << argv[2]
                << " writes it\n";
      ++differing;
    }
  }
  return differing == 0 ? 0 : 1;
}
