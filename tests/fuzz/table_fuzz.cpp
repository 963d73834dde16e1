#include "fuzz/sound.hpp"
#include "slideway/format/table.hpp"

namespace slideway {
namespace {

const TableRequest kRequests[] = {
    {.columns = {"1", "2"}},
    {.columns = {"x_mm", "z_um", "1"}, .may_miss = true},
    {.columns = {"2"}, .delimiter = ";", .decimal = ",", .encoding = "latin-1"},
    {.columns = {"1"}, .delimiter = "blank", .encoding = "utf-16", .header_lines = 2},
};

void require_sound(const Table& table, const TableRequest& request) {
  require(table.columns.size() == request.columns.size(), "columns are lost");
  for (const std::vector<double>& column : table.columns) {
    require(column.size() == table.columns[0].size(), "columns differ in length");
    const bool may_miss = request.may_miss && &column != &table.columns[0];
    for (const double value : column)
      require(std::isfinite(value) || (may_miss && std::isnan(value)), "a value");
  }
  for (const std::string& decision : table.decisions) require_line(decision);
}

}  // namespace
}  // namespace slideway

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slideway;
  for (const TableRequest& request : kRequests)
    ends_well([&] { require_sound(parse_table(text_of(data, size), request), request); });
  return 0;
}
