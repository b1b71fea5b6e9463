// SPDX-License-Identifier: BSD-3-Clause
#include "fem/libraries.hpp"

#include <cstdlib>
#include <deal.II/base/mpi.h>
#include <filesystem>
#include <string>

namespace isostat
{
namespace
{
constexpr const char *base_of_sessions = "OMPI_MCA_orte_tmpdir_base";

/// A temporary folder for Open MPI 4 alone, of a program that mpirun has not started. Such programs share
/// ompi.HOST.USER otherwise, which each removes where it is empty: now and then one that starts at that moment fails.
class SessionFolder
{
public:
  SessionFolder()
  {
    if (std::getenv("OMPI_COMM_WORLD_SIZE") || std::getenv(base_of_sessions))
      return;
    std::error_code none;
    path_ = (std::filesystem::temp_directory_path(none) / "isostat-mpi-XXXXXX").string();
    if (!none && mkdtemp(path_.data()))
      setenv(base_of_sessions, path_.c_str(), 1);
    else
      path_.clear(); // then where the others are
  }
  ~SessionFolder()
  {
    std::error_code ignored;
    if (!path_.empty())
      std::filesystem::remove_all(path_, ignored);
  }
  SessionFolder(const SessionFolder &) = delete;
  SessionFolder &operator=(const SessionFolder &) = delete;

  /// Programs that this one starts have folders of their own.
  void hide() const
  {
    if (!path_.empty())
      unsetenv(base_of_sessions);
  }

private:
  std::string path_;
};
} // namespace

/// PETSc keeps the addresses of its arguments, so they live as long as it does.
struct Libraries::Session
{
  char name[8] = "isostat", *arguments[2] = {name, nullptr}, **first = arguments;
  int n_arguments = 1;
  SessionFolder folder; // removed after MPI has ended
  dealii::Utilities::MPI::MPI_InitFinalize libraries{n_arguments, first, 1};
};

Libraries::Libraries() : session_(std::make_unique<Session>()) { session_->folder.hide(); }
Libraries::~Libraries() = default;

std::string finite_element_library() { return "deal.II " DEAL_II_PACKAGE_VERSION; }
} // namespace isostat
