#include "torture/answer.hpp"

// The bytes choose a problem with its profiles; see draw_problem().
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slideway;
  Draw draw({data, size});
  const Intent intent = draw.once_in(2) ? Intent::hostile : Intent::legal;
  const ProblemFiles files(draw_problem(draw, intent));
  const Answer answer = answer_to(
      files, {.closes_loop = !draw.once_in(4), .with_details = true, .with_curves = true});
  if (!answer.analysis) return 0;
  for (const std::string& fault : faults_of(*answer.analysis)) breach(fault);
  return 0;
}
