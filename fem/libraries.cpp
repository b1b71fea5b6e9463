// SPDX-License-Identifier: BSD-3-Clause
#include "fem/libraries.hpp"

#include <cstdlib>
#include <deal.II/base/mpi.h>
#include <filesystem>
#include <optional>
#include <string>

namespace isostat
{
namespace
{
/// A temporary folder for Open MPI alone, of a program that mpirun has not started. Such programs share ompi.HOST.USER
/// otherwise: with Open MPI 4 each removes it where it is empty, and now and then one that starts at that moment fails;
/// Open MPI 5 leaves it.
class SessionFolder
{
public:
  SessionFolder()
  {
    if (std::getenv("OMPI_COMM_WORLD_SIZE"))
      return;
    std::error_code none;
    path_ = (std::filesystem::temp_directory_path(none) / "isostat-mpi-XXXXXX").string();
    if (const char *before = std::getenv("TMPDIR"))
      before_ = before;
    if (!none && mkdtemp(path_.data()))
      setenv("TMPDIR", path_.c_str(), 1);
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

  /// For all but the start of MPI, which remembers it, temporary files are where they were.
  void hide() const
  {
    if (before_)
      setenv("TMPDIR", before_->c_str(), 1);
    else if (!path_.empty())
      unsetenv("TMPDIR");
  }

private:
  std::string path_;
  std::optional<std::string> before_; ///< TMPDIR
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
