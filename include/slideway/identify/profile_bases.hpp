#pragma once

#include <Eigen/Core>
#include <vector>

#include "slideway/identify/left_out.hpp"
#include "slideway/identify/model.hpp"
#include "slideway/identify/noise.hpp"

namespace slideway {

/// Orthonormal bases, one for each profile, in rows of profiles that stand under one another.
class ProfileBases {
 public:
  /// @param columns  white, in any form
  void add(Eigen::MatrixXd columns);

  [[nodiscard]] const Eigen::MatrixXd& operator[](std::size_t profile) const {
    return bases_[profile];
  }
  [[nodiscard]] std::size_t size() const { return bases_.size(); }

  /// The same in some rows of each profile.
  /// @param rows  rising, of all profiles
  [[nodiscard]] ProfileBases in(const std::vector<Eigen::Index>& rows) const;

  void take_out(Eigen::MatrixXd& white) const;

  /// @param white  rows of that profile
  void take_out_of(std::size_t profile, Eigen::Ref<Eigen::MatrixXd> white) const;

  /// White columns without what the bases span; zero where that is all.
  [[nodiscard]] Eigen::MatrixXd beside(Eigen::MatrixXd white) const;

 private:
  std::vector<Eigen::MatrixXd> bases_;
};

/// Values that are left free, by profile; empty: none in any.
using FreeValues = std::vector<ValueIndices>;

/// What is free in one profile alone, under its noise: its levelling, single values, and columns.
/// @param columns  not white, by profile; empty: none in any
ProfileBases own_bases(const std::vector<const Observation*>& observations,
                       const std::vector<Noise>& noise, const FreeValues& free = {},
                       const std::vector<Eigen::MatrixXd>& columns = {});

/// A unit column for each of these values. @param rows  of the column
Eigen::MatrixXd unit_columns(const ValueIndices& values, Eigen::Index rows);

}  // namespace slideway
