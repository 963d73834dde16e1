#include "slideway/identify/profile_bases.hpp"

#include "slideway/identify/linear_algebra.hpp"

namespace slideway {

void ProfileBases::add(Eigen::MatrixXd columns) {
  bases_.push_back(orthonormal(std::move(columns)));
}

ProfileBases ProfileBases::in(const std::vector<Eigen::Index>& rows) const {
  ProfileBases out;
  auto next = rows.begin();
  Eigen::Index first = 0;
  for (const Eigen::MatrixXd& basis : bases_) {
    std::vector<Eigen::Index> own;
    for (; next != rows.end() && *next < first + basis.rows(); ++next) own.push_back(*next - first);
    out.add(basis(own, Eigen::all));
    first += basis.rows();
  }
  return out;
}

void ProfileBases::take_out_of(std::size_t profile, Eigen::Ref<Eigen::MatrixXd> white) const {
  const Eigen::MatrixXd& basis = bases_[profile];
  project_out(basis, white);
}

void ProfileBases::take_out(Eigen::MatrixXd& white) const {
  Eigen::Index first = 0;
  for (std::size_t i = 0; i < bases_.size(); ++i) {
    take_out_of(i, white.middleRows(first, bases_[i].rows()));
    first += bases_[i].rows();
  }
}

Eigen::MatrixXd ProfileBases::beside(Eigen::MatrixXd white) const {
  const Eigen::VectorXd before = white.colwise().norm();
  for (int pass = 0; pass < 2; ++pass) take_out(white);
  clear_rounding(white, before);
  return white;
}

ProfileBases own_bases(const std::vector<const Observation*>& observations,
                       const std::vector<Noise>& noise, const FreeValues& free,
                       const std::vector<Eigen::MatrixXd>& columns) {
  ProfileBases out;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const Eigen::MatrixXd& nuisances = observations[i]->nuisances;
    const Eigen::MatrixXd units =
        unit_columns(free.empty() ? ValueIndices{} : free[i], nuisances.rows());
    Eigen::MatrixXd own(nuisances.rows(), nuisances.cols() + units.cols());
    own << nuisances, units;
    if (!columns.empty()) append_columns(own, columns[i]);
    noise[i].whiten(own);
    out.add(std::move(own));
  }
  return out;
}

Eigen::MatrixXd unit_columns(const ValueIndices& values, Eigen::Index rows) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows, std::ssize(values));
  for (std::size_t j = 0; j < values.size(); ++j)
    out(values[j], static_cast<Eigen::Index>(j)) = 1.0;
  return out;
}

}  // namespace slideway
