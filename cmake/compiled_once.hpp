#pragma once

#include <Eigen/Dense>

// What of Eigen is compiled once for all rooms: part of the precompiled headers alone, a third of
// the compile time of whoever solves or multiplies. cmake/precompiled.cmake makes the definitions.
namespace Eigen {

extern template class ColPivHouseholderQR<MatrixXd>;
extern template class CompleteOrthogonalDecomposition<MatrixXd>;
extern template class HouseholderQR<MatrixXd>;
extern template class JacobiSVD<MatrixXd>;
extern template class LLT<MatrixXd>;
extern template class SelfAdjointEigenSolver<MatrixXd>;

namespace internal {

using Traits = gebp_traits<double, double>;
using Columns = const_blas_data_mapper<double, Index, ColMajor>;
using Rows = const_blas_data_mapper<double, Index, RowMajor>;

extern template struct gebp_kernel<double, double, Index, blas_data_mapper<double, Index, ColMajor>,
                                   Traits::mr, Traits::nr, false, false>;
extern template struct general_matrix_matrix_product<Index, double, ColMajor, false, double,
                                                     ColMajor, false, ColMajor, 1>;
extern template struct general_matrix_matrix_product<Index, double, RowMajor, false, double,
                                                     ColMajor, false, ColMajor, 1>;
extern template struct general_matrix_matrix_product<Index, double, ColMajor, false, double,
                                                     RowMajor, false, ColMajor, 1>;
extern template struct general_matrix_matrix_product<Index, double, RowMajor, false, double,
                                                     RowMajor, false, ColMajor, 1>;
extern template struct general_matrix_vector_product<Index, double, Columns, ColMajor, false,
                                                     double, Rows, false>;
extern template struct general_matrix_vector_product<Index, double, Rows, RowMajor, false, double,
                                                     Columns, false>;

}  // namespace internal
}  // namespace Eigen
