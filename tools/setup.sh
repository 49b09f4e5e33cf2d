# Functions for tools/run, tools/test and others, which install packages and update build/:
#   help_if_asked "$@"            prints its input and exits, if the first argument asks for help
#   install_packages PACKAGE...   installs missing packages and MuJoCo, or prints how and exits with 2
#   build_release TARGET...       configures $preset and builds the targets in build/
# Made for Debian 12, and also tested on Debian 13 and Ubuntu 24.04 (tests/systems).
# shellcheck shell=bash

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)

preset=release  # or ci, in the same folder

# Packages for building and running. Without --no-install-recommends OpenCV would pull in a desktop.
packages=(
  g++ cmake ninja-build pkg-config
  libosmesa6 libegl1 libopencv-dev libavformat-dev libswscale-dev libeigen3-dev
  libyaml-cpp-dev libtinyxml2-dev libcli11-dev nlohmann-json3-dev libfmt-dev libgtest-dev
  libdeflate-dev libspng-dev libsimdjson-dev libturbojpeg0-dev libnlopt-cxx-dev libboost-dev libssl-dev
  pybind11-dev python3-dev python3-numpy ccache
)

# MuJoCo's wheel, which has the library and its headers, and its hash on each kind of processor. All
# systems get the same, so that physics and textures do not depend on the distribution.
mujoco_version=3.17.0
mujoco_python=311  # any that has wheels; nothing of Python is taken from it
declare -A mujoco_sha256=(
  [x86_64]=d66928d86a2d1b601bbaa4dc11db50214d17d5301bb8afd84721313b67ff0874
  [aarch64]=91a70ed9979c383ff1f5c03f25cc2e1280a8254c1a8e558d5dd7f4184f01efc9
)

say() { printf '%s\n' "$*" >&2; }

help_if_asked() {
  [[ ${1-} == -h || ${1-} == --help ]] || return 0
  cat
  exit 0
}

missing_packages() {
  # dpkg-query fails if it does not know a package, but still lists the others
  local package installed
  installed=$(dpkg-query --show --showformat='${Package}=${db:Status-Status} ' "$@" 2>/dev/null) || true
  for package in "$@"; do
    [[ " $installed" == *" $package=installed "* ]] || printf '%s\n' "$package"
  done
}

warn_unless_tested() {
  local ID='' VERSION_ID='' PRETTY_NAME='this system'
  # shellcheck source=/dev/null
  [[ -r /etc/os-release ]] && . /etc/os-release
  [[ $ID$VERSION_ID == debian1[23] || $ID$VERSION_ID == ubuntu24.04 ]] ||
    say "This is made for Debian 12, and not tested as a whole on $PRETTY_NAME; trying all the same."
}

# Unpacks MuJoCo into .mujoco/VERSION, unless it is there or LCS_MUJOCO_ROOT names another.
fetch_mujoco() {
  local folder=$root/.mujoco/$mujoco_version machine wheel work
  [[ -z ${LCS_MUJOCO_ROOT-} && ! -e $folder ]] || return 0
  machine=$(uname -m)
  python3 -m pip --version >/dev/null 2>&1 || install_debian_packages python3-pip
  wheel="mujoco==$mujoco_version --hash=sha256:${mujoco_sha256[$machine]-none-for-$machine}"
  mkdir -p "$root/.mujoco"
  work=$(mktemp -d "$root/.mujoco/part.XXXXXX")
  say "Downloading MuJoCo $mujoco_version"
  printf '%s\n' "$wheel" >"$work/wheel.txt"
  if ! python3 -m pip download --quiet --disable-pip-version-check --require-hashes --no-deps \
    --only-binary :all: --platform "manylinux_2_28_$machine" --python-version "$mujoco_python" \
    --dest "$work" --requirement "$work/wheel.txt" >&2 ||
    ! python3 -m zipfile --extract "$work"/mujoco-*.whl "$work/wheel" >&2; then
    rm -rf "$work"
    say "MuJoCo $mujoco_version was not downloaded, see above. Try again, or set LCS_MUJOCO_ROOT to a"
    say "folder with include/ and libmujoco.so.*, as its release or its wheel for Python has them."
    exit 2
  fi
  mkdir "$work/whole"
  mv "$work"/wheel/mujoco/{include,libmujoco.so.*} "$work"/wheel/*.dist-info/licenses "$work/whole"
  mv -T "$work/whole" "$folder" 2>/dev/null || [[ -e $folder ]]  # another process may have been first
  rm -rf "$work"
}

install_packages() {
  install_debian_packages "$@"
  fetch_mujoco
}

install_debian_packages() {
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    warn_unless_tested
    say "There is no apt-get here; these have to be installed by other means: $*"
    return
  fi
  local missing
  mapfile -t missing < <(missing_packages "$@")
  [[ ${#missing[@]} -gt 0 ]] || return 0

  warn_unless_tested
  local as_root=(env) install="apt-get install -y --no-install-recommends ${missing[*]}"
  [[ $EUID -eq 0 ]] || as_root=(sudo -n)
  if ! "${as_root[@]}" true 2>/dev/null; then
    say "Packages are missing, and there is neither root nor sudo without a password here. As root:"
    say "  apt-get update && $install"
    exit 2
  fi
  say "Installing ${missing[*]}"
  local apt=("${as_root[@]}" DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=600)
  if ! { "${apt[@]}" update && "${apt[@]}" install -y --no-install-recommends "${missing[@]}"; } >&2
  then
    say "apt-get failed, see above. As root, and when that is mended:"
    say "  apt-get update && $install"
    exit 2
  fi
}

# Configures a fresh build folder, and again after the presets changed or the checkout was moved.
# Ninja detects all other changes itself.
configure_release() {
  local ninja_file=$root/build/build.ninja cache=$root/build/CMakeCache.txt
  if [[ ! -f $ninja_file ]] || ! grep -qsxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$cache"; then
    cmake --preset "$preset" --fresh
  elif [[ $root/CMakePresets.json -nt $ninja_file ]] ||
    { [[ $preset == ci ]] && ! grep -qsx 'LCS_WERROR:.*=ON' "$cache"; }; then
    cmake --preset "$preset"
  fi
}

build_release() {
  (cd "$root" && configure_release && cmake --build --preset release --target "$@") >&2
}
