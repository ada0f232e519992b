// SuiteSparseQR on the matrices of the example `large_rank` of `linalg`: the same three results, timed. An oracle for tests, never linked.
//
//   cargo run --release -p linalg --example large_rank -- DIRECTORY
//   g++ -O2 compare.cpp -I/usr/include/suitesparse -lspqr -lcholmod -lsuitesparseconfig -o compare
//   OPENBLAS_NUM_THREADS=1 ./compare DIRECTORY/*.txt
//
// For each file: rank by Householder QR of C, random combinations W = Q·[0; X] of the left null space (8 columns) and the rows in which they
// vanish, and independent rows as live columns of the R of Cᵀ.

#include <SuiteSparseQR.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <random>
#include <vector>

namespace {

constexpr int combinations = 8;
constexpr double tolerance = 1e-10;
constexpr double zero_row = 1e-8;
constexpr int repetitions = 3;

class Clock {
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();

public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
};

cholmod_sparse *read(const char *path, cholmod_common *common) {
    std::ifstream file(path);
    SuiteSparse_long rows = 0, columns = 0, entries = 0;
    if (!(file >> rows >> columns >> entries)) return nullptr;
    cholmod_triplet *triplet =
        cholmod_l_allocate_triplet(rows, columns, entries, 0, CHOLMOD_REAL, common);
    auto *i = static_cast<SuiteSparse_long *>(triplet->i);
    auto *j = static_cast<SuiteSparse_long *>(triplet->j);
    auto *value = static_cast<double *>(triplet->x);
    for (SuiteSparse_long k = 0; k < entries; ++k) file >> i[k] >> j[k] >> value[k];
    triplet->nnz = entries;
    cholmod_sparse *matrix = cholmod_l_triplet_to_sparse(triplet, entries, common);
    cholmod_l_free_triplet(&triplet, common);
    return matrix;
}

struct Result {
    double factor, sketch, kept;
    SuiteSparse_long rank, kept_rank, zero_rows;
    double total() const { return factor + sketch + kept; }
};

Result measure(cholmod_sparse *c, cholmod_common *common) {
    Result result{};
    const SuiteSparse_long m = c->nrow;

    Clock factor;
    auto *qr = SuiteSparseQR_factorize<double>(SPQR_ORDERING_DEFAULT, tolerance, c, common);
    result.factor = factor.seconds();
    result.rank = common->SPQR_istat[4];

    Clock sketch;
    cholmod_dense *x = cholmod_l_zeros(m, combinations, CHOLMOD_REAL, common);
    auto *entry = static_cast<double *>(x->x);
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform(-std::sqrt(3.0), std::sqrt(3.0));
    for (int k = 0; k < combinations; ++k)
        for (SuiteSparse_long i = result.rank; i < m; ++i) entry[i + k * m] = uniform(random);
    cholmod_dense *w = SuiteSparseQR_qmult<double>(SPQR_QX, qr, x, common);
    const auto *w_entry = static_cast<const double *>(w->x);
    for (SuiteSparse_long i = 0; i < m; ++i) {
        double square = 0;
        for (int k = 0; k < combinations; ++k) square += std::pow(w_entry[i + k * m], 2);
        result.zero_rows += std::sqrt(square / combinations) <= zero_row;
    }
    result.sketch = sketch.seconds();
    cholmod_l_free_dense(&x, common);
    cholmod_l_free_dense(&w, common);
    SuiteSparseQR_free<double>(&qr, common);

    Clock kept;
    cholmod_sparse *transposed = cholmod_l_transpose(c, 1, common);
    cholmod_sparse *r = nullptr;
    SuiteSparse_long *order = nullptr;
    result.kept_rank =
        SuiteSparseQR<double>(SPQR_ORDERING_DEFAULT, tolerance, 0, transposed, &r, &order, common);
    result.kept = kept.seconds();
    cholmod_l_free(m, sizeof(SuiteSparse_long), order, common);
    cholmod_l_free_sparse(&r, common);
    cholmod_l_free_sparse(&transposed, common);
    return result;
}

}  // namespace

int main(int count, char **paths) {
    cholmod_common common;
    cholmod_l_start(&common);
    for (int k = 1; k < count; ++k) {
        cholmod_sparse *c = read(paths[k], &common);
        if (!c) {
            std::fprintf(stderr, "%s: no matrix\n", paths[k]);
            return 1;
        }
        Result best = measure(c, &common);
        for (int again = 1; again < repetitions; ++again) {
            Result next = measure(c, &common);
            if (next.total() < best.total()) best = next;
        }
        std::printf("%-40s %6ld x %6ld, p %5ld | factor %.4f s, sketch %.4f s, kept rows %.4f s, all %.4f s | zero rows %ld%s\n",
                    paths[k], long(c->nrow), long(c->ncol), long(c->nrow) - long(best.rank), best.factor, best.sketch, best.kept,
                    best.total(), long(best.zero_rows), best.rank == best.kept_rank ? "" : ", ranks differ");
        cholmod_l_free_sparse(&c, &common);
    }
    cholmod_l_finish(&common);
}
