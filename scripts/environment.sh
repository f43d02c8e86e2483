# shellcheck shell=bash
# Sourced by the other scripts: where the package lies, and a shell that can use ROS. Sets `root`, the repository,
# `ros_setup`, the setup.bash of ROS Noetic's packages, and `local_host`, the name of this machine for itself.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)

# a python of pyenv or conda before the system's knows nothing of ROS
export PATH=/usr/bin:$PATH

fail() {
  echo "${0##*/}: error: $1" >&2
  exit "${2:-1}"
}

# make, cmake and catkin take such a path apart: it builds, and then every test fails
case $root in
  *[[:space:]\"\'\`\\\$\&\;\|\<\>\(\)*?\[\]#:%]*)
    fail "the folder is '$root': move it to a path without spaces, quotes or any of \\ \$ & ; | < > ( ) * ? [ ] # : %"
    ;;
esac

# shellcheck disable=SC2034  # used by those who source this
ros_setup=/opt/ros/noetic/setup.bash

# roslaunch asks the system for the address of "localhost", which a bare container may not know. There it is told by
# our own hook into python, and all else goes by number; /etc/hosts is the administrator's.
local_host=localhost
if ! getent hosts localhost > /dev/null; then
  local_host=127.0.0.1
  # before cmake is run: catkin puts the variables of that moment around each test
  export PYTHONPATH=$root/scripts/without_localhost${PYTHONPATH:+:$PYTHONPATH}
fi

# Makes what a shell needs to use ROS, without its habit of reading unset variables. $1: a setup.bash
load_ros() {
  local file errors
  file=$(mktemp)
  exec {errors}<> "$file"
  rm "$file"
  set +u
  # shellcheck disable=SC1090
  source "$1" 2>&"$errors"
  set -u
  cat "/proc/$$/fd/$errors" >&2  # only now: what its programs say when Ctrl-C ends them is no error of ours
  exec {errors}>&-
  # a container's host name often resolves to nothing
  [ -n "${ROS_IP:-}${ROS_HOSTNAME:-}" ] || export ROS_HOSTNAME=$local_host
}
