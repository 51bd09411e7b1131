# Sourced by ./run and ./test: installs what is missing, configures and builds. Expects `root` to be
# the project's folder. All it says goes to standard error, so that a program's output stays clean.

say() { printf '%s\n' "$*" >&2; }

fail() {
  say "error: $*"
  exit 1
}

# install_packages LIST...: installs the packages of these lists that are missing. Touches apt only when one is.
install_packages() {
  local packages missing=()
  mapfile -t packages < <(cd "$root" && grep -hv '^[[:space:]]*\(#\|$\)' "$@")
  command -v dpkg-query >/dev/null ||
    fail "this is not Debian: install by hand what $* names, then run cmake as CONTRIBUTING.md shows"
  local installed
  installed=$(dpkg-query -W -f='${db:Status-Abbrev} ${Package}\n' "${packages[@]}" 2>/dev/null |
    awk '$1 == "ii" { print $2 }') || true
  for package in "${packages[@]}"; do
    # A command that is there from elsewhere does as well: a newer npm comes with nodejs itself.
    grep -qx -- "$package" <<<"$installed" || command -v "$package" >/dev/null || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  say "installing ${#missing[@]} of ${#packages[@]} packages: ${missing[*]}"
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null ||
      fail "not root and no sudo; as root: apt-get install --no-install-recommends ${missing[*]}"
    as_root=(sudo)
  fi
  {
    "${as_root[@]}" apt-get update -q
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
      apt-get install -q -y --no-install-recommends "${missing[@]}"
  } >&2 || fail "apt-get could not install: ${missing[*]} (HVAS is made for Debian 12)"
}

# Compilations at a time: one a core, but no more than memory holds (OpenCASCADE's headers take most
# of a GB, sanitizers more).
count_jobs() {
  local cores memory_gb
  cores=$(nproc)
  memory_gb=$(awk '/^MemAvailable/ { print int($2 / 1048576) }' /proc/meminfo)
  local jobs=$((memory_gb < cores ? memory_gb : cores))
  echo $((jobs > 0 ? jobs : 1))
}

# configure PRESET [ARGUMENT...]: with more arguments for cmake.
configure() {
  export CCACHE_BASEDIR="$root" CCACHE_NOHASHDIR=1  # clones in other folders share what is compiled
  export CCACHE_SLOPPINESS=pch_defines,time_macros  # or nothing that uses a precompiled header is kept
  local log
  if ! log=$(cd "$root" && cmake --preset "$@" 2>&1); then
    say "$log"
    fail "cmake --preset $1 failed"
  fi
}

# build PRESET [TARGET...]
build() {
  local preset=$1 targets=()
  shift
  [ $# -gt 0 ] && targets=(--target "$@")
  cmake --build "$root/build/$preset" -j "$(count_jobs)" "${targets[@]}" >&2
}
