#include "slideway/report/document.hpp"
#include "slideway/report/report.hpp"
#include "torture/answer.hpp"
#include "torture/drawn_json.hpp"

// A report as JSON through all that reads one. A text that begins with { is taken as it is, else
// the bytes choose what is changed of a sound one.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slideway;
  Draw draw({data, size});
  const bool is_text = size > 0 && data[0] == '{';
  const std::string text =
      is_text ? std::string(text_of(data, size)) : draw_json(draw, sound_report());
  ends_well([&] {
    const Analysis analysis = parse_report(text, "report.json");
    static_cast<void>(faults_of_outputs(analysis));
    const std::string json = json_report(analysis);
    require(json_report(parse_report(json, "again.json")) == json, "is read back otherwise");
  });
  return 0;
}
