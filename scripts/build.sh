# shellcheck shell=bash
# Sourced: configures where needed, and builds.
source "$(dirname "${BASH_SOURCE[0]}")/environment.sh"

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

# Prints a file below a folder that belongs to another user and that this one may not write.
foreign_file() {
  [ ! -e "$1" ] || find "$1" ! -type l ! -user "$(id -u)" ! -writable -print -quit
}

# Whether targets were built, and no source has changed since. $1: build folder, the rest: targets
is_built() {
  local folder=$1 target stamp
  for target in "${@:2}"; do
    stamp=$folder/built_$target
    [ -e "$stamp" ] || stamp=$folder/built_all
    [ -e "$stamp" ] || return 1
    [ -z "$(find "$root"/{CMakeLists.txt,package.xml,cfg,cmake,config,include,src} -newer "$stamp" -print -quit)" ] ||
      return 1
  done
}

# Whether a build folder was configured for another place: it was moved, copied or seen under another name.
is_from_elsewhere() {
  local cache=$1/CMakeCache.txt
  [ -e "$cache" ] &&
    ! { grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$cache" && grep -qxF "CMAKE_CACHEFILE_DIR:INTERNAL=$1" "$cache"; }
}

# Runs cmake where the options are not those it ran with last; it runs again by itself when a CMakeLists.txt changes.
# $1: build folder, the rest: options
configure() {
  local folder=$1 stamp=$1/configured_with
  shift
  if is_from_elsewhere "$folder"; then
    echo "$folder was configured elsewhere, as $(sed -n 's/^CMAKE_CACHEFILE_DIR:INTERNAL=//p' "$folder/CMakeCache.txt"):" \
      "built afresh"
    rm -rf "$folder"
  fi
  [ "$(cat "$stamp" 2> /dev/null)" != "$*" ] || return 0
  mkdir -p "$folder"
  echo "Configuring $folder"
  cmake -S "$root" -B "$folder" "$@" > "$folder/configure.log" 2>&1 || {
    tail -n 40 "$folder/configure.log" >&2
    fail "cmake could not configure; all its output is in $folder/configure.log"
  }
  echo "$*" > "$stamp"
}

# Ends where another user's files are in the way. $1: build folder
require_own() {
  local foreign
  foreign=$(foreign_file "$1")
  [ -z "$foreign" ] ||
    fail "'$foreign' belongs to another user, $(stat -c %U "$foreign"): remove the folder '$1', or build as that user"
  [ -e "$1" ] || [ -w "$root" ] ||
    fail "'$root' belongs to another user, $(stat -c %U "$root"): make a copy of your own"
}

# Configures where needed and builds. $1: build folder, $2: options of cmake with spaces in between, the rest: targets
build() {
  local folder=$1 memory_mb=1700 options target
  local -a given
  read -r -a given <<< "$2"
  shift 2
  # what another user built can be run
  if [ -n "$(foreign_file "$folder")" ] && is_built "$folder" "$@"; then return; fi
  require_own "$folder"

  [ ! -e "$ros_setup" ] || load_ros "$ros_setup"
  options=(-DLIDAR_PANOPTIC_WERROR=ON "${given[@]}"
    # lines for backtraces and sanitizers, but not the whole of debugging: half the time of compiling
    "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O2 -g1 -DNDEBUG"
    -DPYTHON_EXECUTABLE=/usr/bin/python3 -DPython3_EXECUTABLE=/usr/bin/python3)
  # half the time for seventy programs that each name eighty libraries
  if command -v ld.gold > /dev/null; then options+=("-DCMAKE_EXE_LINKER_FLAGS=-fuse-ld=gold ${LDFLAGS:-}"); fi
  if command -v ccache > /dev/null; then
    options+=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
    export CCACHE_BASEDIR=$root CCACHE_NOHASHDIR=1 CCACHE_SLOPPINESS=pch_defines,time_macros
  fi
  [[ ${given[*]} != *SANITIZE=?* ]] || memory_mb=3400

  configure "$folder" "${options[@]}"
  touch "$folder/started"
  # without the lines of what is up to date
  cmake --build "$folder" --target "$@" -- -j"$(build_jobs $memory_mb)" |
    { grep --line-buffered -vE '^(\[ *[0-9]+%\] )?(Built target|Consolidate compiler|Scanning dependencies)' || true; } ||
    fail "the build failed"
  # as old as the build's beginning: a source that was written meanwhile is newer
  for target in "$@"; do touch -r "$folder/started" "$folder/built_$target"; done
}
