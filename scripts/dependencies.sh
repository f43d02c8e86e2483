# shellcheck shell=bash
# Sourced: installs with apt what is missing.
source "$(dirname "${BASH_SOURCE[0]}")/environment.sh"

# Prints the packages that building, testing and running need, one a line. $1: without_ros for those of the core alone
required_packages() {
  printf '%s\n' g++ cmake make pkg-config \
    libbenchmark-dev libboost-program-options-dev libcairo2-dev libeigen3-dev libgtest-dev libpcl-dev libyaml-cpp-dev \
    nlohmann-json3-dev fonts-dejavu-core pybind11-dev python3-dev python3-distributed python3-matplotlib python3-mypy \
    python3-numpy python3-pytest
  [ "${1:-}" != without_ros ] || return 0
  local name
  if [ ! -e "$ros_setup" ]; then
    printf '%s\n' catkin libnodeletlib-dev libpcl-ros-dev libdynamic-reconfigure-config-init-mutex-dev \
      python3-dynamic-reconfigure libdiagnostic-updater-dev ros-geometry-msgs libvisualization-msgs-dev \
      libtf2-ros-dev ros-message-generation ros-message-runtime librosbag-storage-dev librostest-dev \
      python3-rostest python3-roslaunch libnodeletlib-tools tf2-tools rosbash python3-rostopic python3-rosnode \
      python3-rosservice python3-rosmsg python3-rosbag topic-tools python3-geometry-msgs python3-sensor-msgs \
      python3-visualization-msgs python3-diagnostic-msgs python3-nodelet python3-tf2-ros rviz
  elif dpkg-query -W ros-noetic-roscpp > /dev/null 2>&1; then  # not where it was built from source
    for name in catkin diagnostic-updater dynamic-reconfigure message-generation message-runtime nodelet pcl-ros pluginlib \
      rosbag-storage roslaunch rostest rviz tf2-ros visualization-msgs; do
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

# Whether sudo lets this user install: without a question, or with one where there is somebody to answer it.
can_use_sudo() {
  command -v sudo > /dev/null || return 1
  sudo -n true 2> /dev/null || { [ -t 0 ] && sudo -v; }
}

# Installs with apt those of the packages given that are missing, as root or with sudo.
install_packages() {
  local missing as_root=() log unknown
  command -v dpkg-query > /dev/null ||
    fail "no dpkg here: expected Debian 11 to 13 or Ubuntu 20.04; on other systems install ROS 1 and PCL, then use cmake"
  mapfile -t missing < <(missing_packages "$@")
  [ ${#missing[@]} -gt 0 ] || return 0

  if [ "$(id -u)" -ne 0 ]; then
    can_use_sudo || fail "${#missing[@]} packages are missing, and this user can install none. Ask for:
  apt-get update && apt-get install -y --no-install-recommends ${missing[*]}"
    as_root=(sudo)
  fi
  echo "Installing ${#missing[@]} packages: ${missing[*]}"
  log=$(mktemp)
  if ! { "${as_root[@]}" apt-get update &&
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${missing[@]}"; } \
    > "$log" 2>&1 < /dev/null; then
    unknown=$(sed -n 's/^E: Unable to locate package //p' "$log" | tr '\n' ' ')
    [ -z "$unknown" ] ||
      fail "apt knows no package ${unknown% } here. Where ROS 1 comes from ROS's own packages, as on Ubuntu 20.04, install
  it in /opt/ros/noetic first (http://wiki.ros.org/noetic/Installation). The library without ROS: ./check --without-ros"
    tail -n 20 "$log" >&2
    fail "apt-get could not install the packages; its output is in $log"
  fi
  rm -f "$log"
}

# At once, so that who has to ask for them asks once. $1: as of required_packages, the rest: further packages
install_dependencies() {
  local required
  mapfile -t required < <(required_packages "$1")
  install_packages "${required[@]}" "${@:2}"
}
