#include <iostream>

#include "slideway/trace/analysis.hpp"

int main(int argc, char** argv) try {
  const slideway::Problem problem = slideway::read_problem(argc > 1 ? argv[1] : "problem.toml");
  const slideway::Analysis analysis = slideway::analyse(problem, slideway::read_profiles(problem));

  for (const slideway::FittedParameter& p : analysis.result.final->parameters)
    if (p.identifiable)  // value ± U, k = p.coverage_factor
      std::cout << p.name << " = " << *p.value << " ± " << *p.expanded_uncertainty << " " << p.unit
                << "\n";
  std::cout << "Is an effect missing? " << slideway::text_of(analysis.trace->verdict) << "\n";
} catch (const std::exception& error) {  // UsageError: the problem, DataError: a data file
  std::cerr << error.what() << "\n";
  return 1;
}
