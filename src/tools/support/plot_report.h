#pragma once

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

namespace lidar_panoptic_clustering
{
namespace detail
{
/// Where this package's Python part lies beside the running program, in a build or an installation; else empty.
inline std::string pythonFolder()
{
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  for (const char* place : {"../python3/dist-packages", "../python", "../lib/python3/dist-packages"})
  {
    const auto folder = (program.parent_path() / place).lexically_normal();
    if (std::filesystem::exists(folder / "lidar_panoptic_clustering" / "__init__.py", error)) return folder.string();
  }
  return "";
}

/// The environment, with that folder before PYTHONPATH's.
inline std::vector<std::string> pythonEnvironment()
{
  std::vector<std::string> variables;
  std::string path = pythonFolder();
  for (char** variable = environ; *variable != nullptr; ++variable)
  {
    const std::string text = *variable;
    if (text.rfind("PYTHONPATH=", 0) != 0)
      variables.push_back(text);
    else if (const std::string given = text.substr(text.find('=') + 1); !given.empty())
      path += (path.empty() ? "" : ":") + given;
  }
  if (!path.empty()) variables.push_back("PYTHONPATH=" + path);
  return variables;
}

/// Exit status; 127 where there is no such program. `silenced`: of STDOUT_FILENO and STDERR_FILENO.
inline int runPython(const std::vector<std::string>& command, const std::vector<int>& silenced)
{
  const std::vector<std::string> environment = pythonEnvironment();
  std::vector<char*> arguments, variables;
  for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
  for (const std::string& variable : environment) variables.push_back(const_cast<char*>(variable.c_str()));
  arguments.push_back(nullptr), variables.push_back(nullptr);

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  for (const int stream : silenced) posix_spawn_file_actions_addopen(&files, stream, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failed = posix_spawnp(&child, arguments[0], &files, nullptr, arguments.data(), variables.data());
  posix_spawn_file_actions_destroy(&files);
  int status = 0;
  while (failed == 0 && waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return 127;
  return failed != 0 ? 127 : WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}
}  // namespace detail

/// Draws the charts of a saved report into a folder by `python3 -m lidar_panoptic_clustering plot`: the first python3
/// of the path, or the system's where only that one has matplotlib. Throws std::runtime_error with what is missing and
/// what to run once it is there.
inline void plotReport(const std::string& report, const std::string& folder)
{
  const std::string later = "the report is in " + report +
                            ", and drawn by: python3 -m lidar_panoptic_clustering plot --output " + folder + " " +
                            report;
  for (const char* python : {"python3", "/usr/bin/python3"})
  {
    if (detail::runPython({python, "-c", "import matplotlib"}, {STDOUT_FILENO, STDERR_FILENO}) != 0) continue;
    const int status = detail::runPython(
        {python, "-m", "lidar_panoptic_clustering", "plot", "--output", folder, report}, {STDOUT_FILENO});
    if (status == 0) return;
    throw std::runtime_error("the charts were not drawn, " + std::string(python) + " ended with status " +
                             std::to_string(status) +
                             " (where it finds no module lidar_panoptic_clustering: source the workspace's setup.bash, "
                             "or pip install this package); " +
                             later);
  }
  throw std::runtime_error(
      "the charts were not drawn, they need python3 with matplotlib: apt-get install python3-matplotlib, or pip "
      "install "
      "matplotlib; " +
      later);
}
}  // namespace lidar_panoptic_clustering
