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

void ProfileBases::take_out(Eigen::MatrixXd& white) const {
  Eigen::Index first = 0;
  for (const Eigen::MatrixXd& basis : bases_) {
    auto rows = white.middleRows(first, basis.rows());
    rows -= basis * (basis.transpose() * rows).eval();
    first += basis.rows();
  }
}

Eigen::MatrixXd ProfileBases::beside(Eigen::MatrixXd white) const {
  constexpr double kRounding = 1e-10;  // of a column: what is left of one that the bases make
  const Eigen::RowVectorXd whole = white.colwise().norm();
  for (int pass = 0; pass < 2; ++pass) take_out(white);
  for (Eigen::Index j = 0; j < white.cols(); ++j)
    if (white.col(j).norm() <= kRounding * whole[j]) white.col(j).setZero();
  return white;
}

}  // namespace slideway
