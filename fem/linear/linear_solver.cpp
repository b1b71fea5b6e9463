// SPDX-License-Identifier: BSD-3-Clause
#include "fem/linear/linear_solver.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <sstream>
#include <utility>

namespace isostat
{
struct LinearSolver::Parts
{
  std::string prefix, given; ///< of options; these as they were given
  DirectSolver direct;
  std::function<void(KSP)> prepare;
  PetscOptions options = nullptr;
  KSP ksp = nullptr;
  Mat factor = nullptr;                         ///< of the KSP; null: an iteration
  bool has_options = false, is_checked = false; ///< that have been read; that something has made use of

  ~Parts()
  {
    KSPDestroy(&ksp);
    PetscOptionsDestroy(&options);
  }
};

namespace
{
/// The innermost message of PETSc's last error.
std::string first_message; // NOLINT: PETSc hands a context to its handlers, but not to who asks for the message

PetscErrorCode keep_message(MPI_Comm, int, const char *, const char *, PetscErrorCode code, PetscErrorType type,
                            const char *message, void *)
{
  if (type == PETSC_ERROR_INITIAL)
    first_message = message ? message : "";
  return code;
}

/// While it lives, PETSc takes options from these alone, and leaves messages to petsc_check() and check_options().
class OwnOptions
{
public:
  explicit OwnOptions(PetscOptions options)
  {
    petsc_check(PetscOptionsPush(options));
    PetscPushErrorHandler(keep_message, nullptr);
  }
  ~OwnOptions()
  {
    PetscPopErrorHandler();
    PetscOptionsPop();
  }
  OwnOptions(const OwnOptions &) = delete;
  OwnOptions &operator=(const OwnOptions &) = delete;
};

/// Of the options with a prefix the one whose value a message names, else all.
std::string options_of(const std::string &message, const std::string &given, const std::string &prefix)
{
  const auto words_of = [](const std::string &text) {
    std::istringstream words(text);
    return std::vector<std::string>(std::istream_iterator<std::string>(words), {});
  };
  std::vector<std::string> named;
  for (std::string &word : words_of(message))
    named.push_back(word.substr(0, word.find_last_not_of(".,:;") + 1));
  std::string all, option;
  for (const std::string &word : words_of(given))
    {
      if (word.starts_with("-" + prefix))
        option = word;
      else if (!option.empty() && std::ranges::find(named, word) != named.end())
        return option + " " + word;
      all += (all.empty() ? "" : " ") + word;
    }
  return all;
}

/// An error while options are read is one of the options.
void check_options(PetscErrorCode code, const std::string &given, const std::string &prefix)
{
  if (!code)
    return;
  const char *text = nullptr;
  PetscErrorMessage(code, &text, nullptr);
  const std::string said = !first_message.empty() ? first_message : text ? text : "invalid value";
  throw InputError(fmt::format("PETSc refuses {}: {}. Give names and values of PETSc's manual pages.",
                               options_of(said, given, prefix), said.substr(0, said.find('\n'))));
}
} // namespace

LinearSolver::LinearSolver(MPI_Comm communicator, std::string prefix, const std::string &options, DirectSolver direct,
                           std::function<void(KSP)> prepare, const std::string &split_blocks)
    : parts_(new Parts{std::move(prefix), options, std::move(direct), std::move(prepare)})
{
  parts_->is_checked = options.empty();
  petsc_check(PetscOptionsCreate(&parts_->options));
  petsc_check(PetscOptionsInsertString(parts_->options, options.c_str()));
  if (splits())
    petsc_check(PetscOptionsInsertString(parts_->options, (split_blocks + ' ' + options).c_str()));
  petsc_check(KSPCreate(communicator, &parts_->ksp));
}

LinearSolver::~LinearSolver() = default;
LinearSolver::LinearSolver(LinearSolver &&) noexcept = default;

bool LinearSolver::splits() const
{
  char type[16] = "";
  petsc_check(PetscOptionsGetString(parts_->options, parts_->prefix.c_str(), "-pc_type", type, sizeof type, nullptr));
  return std::string_view(type) == PCFIELDSPLIT;
}

/// LU unless the options say otherwise, GMRES if they name another preconditioner alone. A pivot is zero if it is 0,
/// whatever its unit.
void LinearSolver::read_options()
{
  Parts &p = *parts_;
  PC pc = nullptr;
  petsc_check(KSPGetPC(p.ksp, &pc));
  petsc_check(KSPSetOptionsPrefix(p.ksp, p.prefix.c_str()));
  PetscBool preconditions = PETSC_FALSE;
  petsc_check(PetscOptionsHasName(p.options, p.prefix.c_str(), "-pc_type", &preconditions));
  petsc_check(KSPSetType(p.ksp, preconditions ? KSPGMRES : KSPPREONLY));
  petsc_check(KSPSetTolerances(p.ksp, 1e-10, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
  petsc_check(PCSetType(pc, splits() ? PCFIELDSPLIT : PCLU));
  petsc_check(PCFactorSetMatSolverType(pc, p.direct.package));
  petsc_check(PCFactorSetZeroPivot(pc, 0));
  if (p.direct.ordering)
    petsc_check(PCFactorSetMatOrderingType(pc, p.direct.ordering));
  if (p.prepare)
    p.prepare(p.ksp);
  petsc_check(KSPGMRESSetRestart(p.ksp, 200)); // PETSc's 30 need more iterations: docs/column.md
  check_options(KSPSetFromOptions(p.ksp), p.given, p.prefix);
  KSPType method = nullptr;
  PCType preconditioner = nullptr;
  MatSolverType package = nullptr;
  petsc_check(KSPGetType(p.ksp, &method));
  petsc_check(PCGetType(pc, &preconditioner));
  effort_.method = fmt::format("{}, {}", method, preconditioner);
  refuse_no_solution(method, preconditioner);
  if (std::string_view(method) != KSPPREONLY || std::string_view(preconditioner) != PCLU)
    return;
  petsc_check(PCFactorSetUpMatSolverType(pc));
  petsc_check(PCFactorGetMatrix(pc, &p.factor));
  petsc_check(PCFactorGetMatSolverType(pc, &package));
  if (package && std::string_view(package) == MATSOLVERMUMPS)
    for (const auto &[number, value] : p.direct.icntl)
      petsc_check(MatMumpsSetIcntl(p.factor, number, value));
}

/// What leaves the start, or one preconditioning, as the solution without a word.
void LinearSolver::refuse_no_solution(const std::string &method, const std::string &preconditioner) const
{
  constexpr std::string_view direct[] = {PCLU, PCCHOLESKY, PCREDUNDANT};
  if (method == KSPPREONLY && std::ranges::find(direct, preconditioner) == std::end(direct))
    throw InputError(fmt::format("-{0}ksp_type preonly with -{0}pc_type {1} applies a preconditioner once, which "
                                 "solves nothing. Give another ksp_type, or pc_type lu.",
                                 parts_->prefix, preconditioner));
  PetscReal relative = 0;
  petsc_check(KSPGetTolerances(parts_->ksp, &relative, nullptr, nullptr, nullptr));
  if (!(relative < 1))
    throw InputError(fmt::format("-{}ksp_rtol {:g}; must be below 1, or no iteration is done. Give for example 1e-10.",
                                 parts_->prefix, relative));
}

/// When all has been read: what PETSc reports of an iteration it is asked after the first one.
void LinearSolver::refuse_unused()
{
  const Parts &p = *parts_;
  parts_->is_checked = true;
  PetscInt n = 0;
  char **names = nullptr, **values = nullptr;
  petsc_check(PetscOptionsLeftGet(parts_->options, &n, &names, &values));
  std::string unused;
  for (PetscInt k = 0; k < n && unused.empty(); ++k)
    if (std::string_view(names[k]).starts_with(parts_->prefix) && p.given.find(names[k]) != std::string::npos)
      unused = names[k];
  petsc_check(PetscOptionsLeftRestore(parts_->options, &n, &names, &values));
  if (!unused.empty())
    throw InputError(fmt::format("the option -{} has no effect on this linear system ({}). Correct its name, give the "
                                 "solver that has it, or remove it.",
                                 unused, effort_.method));
}

void LinearSolver::set_matrix(Mat matrix)
{
  Parts &p = *parts_;
  const OwnOptions own(p.options);
  petsc_check(KSPSetOperators(p.ksp, matrix, matrix));
  if (!p.has_options)
    read_options();
  p.has_options = true;
  const PetscErrorCode code = KSPSetUp(p.ksp);
  if (p.is_checked)
    petsc_check(code);
  else
    check_options(code, p.given, p.prefix);
  petsc_check(KSPSetUpOnBlocks(p.ksp));
  PC pc = nullptr;
  PCFailedReason reason = PC_NOERROR;
  petsc_check(KSPGetPC(p.ksp, &pc));
  petsc_check(PCGetFailedReason(pc, &reason));
  MatFactorError error = MAT_FACTOR_NOERROR;
  if (p.factor)
    petsc_check(MatFactorGetError(p.factor, &error));
  if (reason != PC_NOERROR || error != MAT_FACTOR_NOERROR)
    {
      petsc_check(KSPReset(p.ksp)); // MUMPS does not recover: the next matrix gets a new factor
      p.factor = nullptr;
      p.has_options = false;
      throw RunFailure(fmt::format("the matrix of {} is singular, or has no preconditioner (PETSc: {}, {})", p.prefix,
                                   PCFailedReasons[reason], static_cast<int>(error)));
    }
  if (p.is_checked)
    return;
  if (!p.factor) // blocks and levels read theirs when they are used
    {
      Vec in = nullptr, out = nullptr;
      petsc_check(MatCreateVecs(matrix, &out, &in));
      const PetscVector zero(in), none(out);
      petsc_check(VecSet(in, 0));
      petsc_check(KSPSolve(p.ksp, in, out));
    }
  refuse_unused();
}

void LinearSolver::solve(Vec in, Vec out)
{
  Parts &p = *parts_;
  if (p.factor)
    return petsc_check(MatSolve(p.factor, in, out));
  const OwnOptions own(p.options);
  petsc_check(KSPSolve(p.ksp, in, out));
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  PetscInt iterations = 0;
  PetscReal residual = 0;
  petsc_check(KSPGetConvergedReason(p.ksp, &reason));
  petsc_check(KSPGetIterationNumber(p.ksp, &iterations));
  petsc_check(KSPGetResidualNorm(p.ksp, &residual));
  if (reason < 0)
    throw RunFailure(fmt::format("the linear system {}({}) has not converged: {} after {} iterations, norm of the "
                                 "residual {:.3g}. Give it another solver or tolerance (-{}ksp_max_it), or leave its "
                                 "options out for the direct one.",
                                 p.prefix, effort_.method, KSPConvergedReasons[reason], iterations, residual,
                                 p.prefix));
  ++effort_.solves;
  effort_.iterations += static_cast<std::uint64_t>(iterations);
  effort_.most = std::max(effort_.most, static_cast<std::uint64_t>(iterations));
}
} // namespace isostat
