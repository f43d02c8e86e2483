# shellcheck shell=bash
# Sourced by ./check and ./demo: installs what is missing with apt, configures and builds. Sets `root`, the repository.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# a python of pyenv or conda before the system's knows nothing of ROS
export PATH=/usr/bin:$PATH

fail() {
  echo "${0##*/}: error: $1" >&2
  exit "${2:-1}"
}

ros_setup=/opt/ros/noetic/setup.bash

# Prints the packages that building, testing and running need, one a line.
required_packages() {
  printf '%s\n' g++ cmake make pkg-config \
    libbenchmark-dev libboost-program-options-dev libcairo2-dev libeigen3-dev libgtest-dev libpcl-dev libyaml-cpp-dev \
    nlohmann-json3-dev fonts-dejavu-core
  local name
  if [ ! -e "$ros_setup" ]; then
    printf '%s\n' catkin libnodeletlib-dev libpcl-ros-dev libdynamic-reconfigure-config-init-mutex-dev \
      python3-dynamic-reconfigure libdiagnostic-updater-dev libvisualization-msgs-dev libtf2-ros-dev \
      librosbag-storage-dev librostest-dev python3-rostest python3-roslaunch libnodeletlib-tools tf2-tools rosbash \
      python3-rostopic python3-rosnode python3-rosservice python3-rosmsg python3-rosbag topic-tools python3-sensor-msgs \
      python3-visualization-msgs python3-diagnostic-msgs python3-nodelet python3-tf2-ros rviz
  elif dpkg-query -W ros-noetic-roscpp > /dev/null 2>&1; then  # not where it was built from source
    for name in catkin diagnostic-updater dynamic-reconfigure nodelet pcl-ros pluginlib rosbag-storage roslaunch rostest \
      rviz tf2-ros visualization-msgs; do
      echo "ros-noetic-$name"
    done
  fi
}

# Prints those of the packages given that are not installed.
missing_packages() {
  local name
  local -A installed=()
  while read -r name; do installed[$name]=1; done < <(
    dpkg-query -W -f '${db:Status-Abbrev} ${Package}\n' "$@" 2> /dev/null | sed -n 's/^ii *//p')
  for name in "$@"; do [ -n "${installed[$name]:-}" ] || echo "$name"; done
}

install_dependencies() {
  ensure_localhost
  local required
  mapfile -t required < <(required_packages)
  install_packages "${required[@]}"
}

# Installs those of the packages given that are missing, as root or with sudo.
install_packages() {
  local missing as_root=()
  command -v dpkg-query > /dev/null ||
    fail "no dpkg here: expected Debian 12 or Ubuntu 20.04; on other systems install ROS 1 and PCL, then use cmake"
  mapfile -t missing < <(missing_packages "$@")
  [ ${#missing[@]} -gt 0 ] || return 0

  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo > /dev/null || fail "not root, and no sudo, to install with apt: ${missing[*]}"
    as_root=(sudo)
  fi
  echo "Installing ${#missing[@]} packages: ${missing[*]}"
  local log
  log=$(mktemp)
  if ! { "${as_root[@]}" apt-get update &&
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${missing[@]}"; } \
    > "$log" 2>&1 < /dev/null; then
    tail -n 20 "$log" >&2
    fail "apt-get could not install the packages; its output is in $log"
  fi
  rm -f "$log"
}

# roslaunch and rostest look up "localhost", which a minimal system may not know.
ensure_localhost() {
  ! getent hosts localhost > /dev/null || return 0
  local as_root=()
  [ "$(id -u)" -eq 0 ] || as_root=(sudo)
  echo "Adding localhost to /etc/hosts"
  echo '127.0.0.1 localhost' | "${as_root[@]}" tee -a /etc/hosts > /dev/null ||
    fail "this system does not know the name localhost; add the line '127.0.0.1 localhost' to /etc/hosts"
}

# As many compilers as there are processors, but no more than fit into the memory: the largest file takes 1.7 GB, or
# twice that under a sanitizer. $1: MB a compiler
build_jobs() {
  local processors memory_mb fit
  processors=$(nproc)
  memory_mb=$(awk '/^MemAvailable:/ { print int($2 / 1024) }' /proc/meminfo)
  fit=$((${memory_mb:-2000} / $1))
  [ "$fit" -ge 1 ] || fit=1
  echo $((processors < fit ? processors : fit))
}

# Makes what a shell needs to use ROS, without its habit of reading unset variables.
load_ros() {
  set +u
  # shellcheck disable=SC1090
  source "$1"
  set -u
  # a container's host name often resolves to nothing
  [ -n "${ROS_IP:-}${ROS_HOSTNAME:-}" ] || export ROS_HOSTNAME=localhost
}

# Configures where needed and builds. $1: build folder, $2: sanitizer or nothing, the rest: targets
build() {
  local folder=$1 sanitizer=$2 memory_mb=1700
  shift 2
  [ ! -e "$ros_setup" ] || load_ros "$ros_setup"
  local options=(-S "$root" -B "$folder" -DLIDAR_PANOPTIC_WERROR=ON "-DLIDAR_PANOPTIC_SANITIZE=$sanitizer"
    # lines for backtraces and sanitizers, but not the whole of debugging: half the time of compiling
    "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O2 -g1 -DNDEBUG"
    -DPYTHON_EXECUTABLE=/usr/bin/python3 -DPython3_EXECUTABLE=/usr/bin/python3)
  if command -v ccache > /dev/null; then
    options+=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
    export CCACHE_BASEDIR=$root CCACHE_NOHASHDIR=1 CCACHE_SLOPPINESS=pch_defines,time_macros
  fi
  [ -z "$sanitizer" ] || memory_mb=3400

  # cmake configures again by itself when a CMakeLists.txt changes
  local stamp=$folder/configured_with
  if [ "$(cat "$stamp" 2> /dev/null)" != "${options[*]}" ]; then
    mkdir -p "$folder"
    echo "Configuring $folder"
    cmake "${options[@]}" > "$folder/configure.log" 2>&1 || {
      tail -n 40 "$folder/configure.log" >&2
      fail "cmake could not configure; all its output is in $folder/configure.log"
    }
    echo "${options[*]}" > "$stamp"
  fi
  # without the lines of what is up to date
  cmake --build "$folder" --target "$@" -- -j"$(build_jobs $memory_mb)" |
    { grep --line-buffered -vE '^(\[ *[0-9]+%\] )?(Built target|Consolidate compiler|Scanning dependencies)' || true; } ||
    fail "the build failed"
}
