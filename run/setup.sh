#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Everything that must be there before the programs run: packages, then one build.
#   bash run/setup.sh            csd and cfd
#   bash run/setup.sh --tests    the same and all tests
# Safe to run twice: what is there is left alone. The full log is build/setup.log.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

packages=(g++ cmake ninja-build openmpi-bin libopenmpi-dev libeigen3-dev libhdf5-openmpi-dev libmetis-dev libp4est-dev libfmt-dev
          libtomlplusplus-dev libcli11-dev python3 python3-numpy python3-h5py python3-matplotlib)
tests=OFF
for argument in "$@"; do
  case "$argument" in
    --tests) tests=ON; packages+=(libgtest-dev) ;;
    *) echo "setup.sh: unknown argument '$argument' (only --tests)" >&2; exit 2 ;;
  esac
done
mkdir -p build
log=build/setup.log
: > "$log"
say() { printf '%s\n' "$*"; printf '%s\n' "$*" >> "$log"; }
fail() { say "$1"; tail -n "${2:-40}" "$log" >&2; exit 1; }

# --- packages ------------------------------------------------------------------------------------------------------
install_packages() {
  if ! command -v dpkg-query > /dev/null; then
    say "set-up: this is not Debian or Ubuntu; the libraries behind these packages are needed: ${packages[*]}"
    return
  fi
  local missing=() package
  for package in "${packages[@]}"; do
    [[ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2> /dev/null || true)" == installed ]] || missing+=("$package")
  done
  if (( ${#missing[@]} == 0 )); then say "set-up: all packages are there"; return; fi
  local line="apt-get install -y --no-install-recommends ${missing[*]}" as_root=()
  if (( EUID != 0 )); then
    if ! sudo -n true 2> /dev/null; then
      say "set-up: packages are missing and this user may not install them. Please run"
      say "    sudo apt-get update && sudo $line"
      say "and start again."
      exit 1
    fi
    as_root=(sudo -n)
  fi
  say "set-up: installing ${#missing[@]} packages (about half a minute): ${missing[*]}"
  local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=120 -o Acquire::Retries=3)
  "${apt[@]}" update >> "$log" 2>&1 || say "set-up: apt-get update failed; trying with the lists that are there"
  "${apt[@]}" install -y --no-install-recommends "${missing[@]}" >> "$log" 2>&1 ||
    fail "set-up: the packages could not be installed; the line was: $line"
}

# --- build ---------------------------------------------------------------------------------------------------------
show_progress() {  # ninja's "[12/90] ..." lines: in place on a terminal, else one line every 15 s
  local line last=0 now
  while IFS= read -r line; do
    printf '%s\n' "$line" >> "$log"
    [[ "$line" =~ ^\[([0-9]+)/([0-9]+)\] ]] || continue
    if [[ -t 1 ]]; then
      printf '\r\033[Kbuild: %s of %s' "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}"
    else
      now=$SECONDS
      if (( now - last >= 15 )); then last=$now; printf 'build: %s of %s\n' "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}"; fi
    fi
  done
  [[ -t 1 ]] && printf '\r\033[K'
  return 0
}

build() {
  local started=$SECONDS jobs memory_gb
  jobs=$(nproc)
  memory_gb=$(awk '/MemAvailable/ {print int($2 / 1048576)}' /proc/meminfo 2> /dev/null || echo 4)
  (( jobs > memory_gb )) && jobs=$(( memory_gb > 1 ? memory_gb : 1 ))  # a compiler job takes up to 1 GB
  local options=() targets=(--target csd cfd breakwave_coupling) what="csd, cfd and the coupling library"
  if [[ $tests == ON ]]; then
    options=(-DBREAKWAVE_TESTS=ON) targets=() what="csd, cfd and the tests"
  elif [[ ! -f build/CMakeCache.txt ]]; then
    options=(-DBREAKWAVE_TESTS=OFF)
  fi
  cmake --preset release "${options[@]}" >> "$log" 2>&1 || fail "build: cmake could not configure (build/setup.log):"
  say "build: $what with $jobs jobs"
  cmake --build build -j "$jobs" "${targets[@]}" 2>&1 | show_progress || fail "build: failed (build/setup.log):" 60
  say "build: done in $(( SECONDS - started )) s"
}

install_packages
build
