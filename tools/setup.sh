#!/usr/bin/env bash
# Checks for everything that `npm test` needs, and installs missing parts if it can.
# `setup.sh PART…` checks only for these parts, and `setup.sh build` for those that `npm start` and `npm run build` need:
# rust, wasm, packages and bindgen.
#
# rust      Rust >= 1.88                           from rustup; not installed, the script says how
#           a C linker                             apt on Debian and Ubuntu
# lints     rustfmt and clippy                     rustup
# vulkan    a Vulkan driver for the GPU tests      apt on Debian and Ubuntu (Mesa's software driver, lavapipe)
# wasm      the wasm32-unknown-unknown target      rustup; on Debian 12 without rustup's server, Debian's compiler
#           and the source of std
# packages  the packages of package-lock.json      npm ci
# bundlers  the packages of tests/bundlers         npm ci
# peers     the packages of tests/peers            npm ci
# bindgen   wasm-bindgen, of Cargo.lock's version  cargo install, into target/setup
# chromium  Chromium and chromedriver              apt on Debian; elsewhere the script says how
# firefox   Firefox                                apt on Debian; elsewhere the script says how
#           Xvfb, if there is no display           apt on Debian and Ubuntu
#
# It installs only missing parts, so a second run changes nothing.
# On macOS and Windows it installs only what rustup, cargo and npm can; the GPU tests use Metal or Direct3D 12 there.
set -euo pipefail
cd "$(dirname "$0")/.."

parts=" $* "
[ "$*" != build ] || parts=" rust wasm packages bindgen "
is_wanted() { [ "$parts" = "  " ] || [[ $parts == *" $1 "* ]]; } # PART

say() { echo "setup: $*"; }
stop() { # WHAT IS MISSING, WHAT TO DO…
  echo "setup: stopped: $1" >&2
  shift
  printf '  %s\n' "$@" >&2
  exit 1
}
has() { command -v "$1" >/dev/null 2>&1; }

# Runs a command for at most SECONDS seconds, because a network that drops packets would block it for ever.
within() { # SECONDS COMMAND…
  if has timeout; then timeout "$@"; else perl -e 'alarm shift; exec @ARGV' "$@"; fi
}

# Sets `root` to the prefix that runs a command as root; fails if there is none.
root=()
find_root() {
  if [ "$(id -u)" = 0 ]; then
    root=()
  elif has sudo && { sudo -n true 2>/dev/null || [ -t 0 ]; }; then
    root=(sudo)
  else
    return 1
  fi
}

# Installs Debian packages. It fetches the package lists only if the first try fails, because they may be absent
# or out of date. --no-remove: stops instead of removing packages of the user.
apt_install() { # WHY PACKAGE…
  local why=$1
  shift
  has apt-get || stop "$why is missing, and this system has no apt-get to install it with." \
    "Install what your system calls: $*"
  find_root || stop "$why is missing, and installing it needs root." \
    "Run: sudo apt-get update && sudo apt-get install --no-install-recommends $*"
  say "installing $why: $*"
  local apt=("${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o DPkg::Lock::Timeout=300)
  local install=("${apt[@]}" install --no-install-recommends --no-remove "$@")
  mkdir -p target/setup
  local log=target/setup/apt.log
  "${install[@]}" >"$log" 2>&1 || { "${apt[@]}" update && "${install[@]}"; } >>"$log" 2>&1 || {
    tail -n 15 "$log" >&2
    stop "apt-get could not install $why." "Its messages are above and in $log. Install by hand: $*"
  }
}

system=$(uname -s)

# --- Rust -------------------------------------------------------------------------------------------------
get_rust="Install Rust from https://rustup.rs and open a new shell. Debian 12 has it without rustup:"
get_rust_debian="apt-get install rustc-web cargo-web rustfmt-web rust-web-clippy"
has cargo && has rustc || stop "cargo and rustc are not on the PATH." "$get_rust" "$get_rust_debian"
version=$(rustc --version | cut -d' ' -f2) || stop "rustc does not run (see above)." "Repair it: rustup update stable"
IFS=. read -r major minor _ <<<"$version"
[ "$major" -gt 1 ] || [ "$minor" -ge 88 ] ||
  stop "rustc is $version; edgeflip needs 1.88 or newer." "Run: rustup update stable"
for tool in fmt clippy; do
  is_wanted lints || break
  cargo "$tool" --version >/dev/null 2>&1 && continue
  component=${tool/#fmt/rustfmt}
  has rustup && within 180 rustup component add "$component" ||
    stop "cargo $tool is missing." "Run: rustup component add $component"
done

# --- C linker ---------------------------------------------------------------------------------------------
# rustc links through cc; on Windows the linker comes with the Visual Studio build tools that rustup asks for.
is_wanted rust && case $system in
  Linux) has cc || apt_install "a C linker" gcc libc6-dev ;;
  Darwin) has cc || stop "cc, the C linker, is missing." "Run: xcode-select --install" ;;
esac

# --- Vulkan driver ----------------------------------------------------------------------------------------
# The loader (libvulkan.so.1) finds drivers by their JSON files. Any driver suffices; this installs a software driver.
has_vulkan() {
  [ -z "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ] || return 0 # the user has chosen a driver
  local drivers=(/usr/share/vulkan/icd.d/*.json /usr/local/share/vulkan/icd.d/*.json /etc/vulkan/icd.d/*.json)
  local libraries=({,/usr}/lib/*/libvulkan.so.1 /usr/{,local/}lib{,64}/libvulkan.so.1)
  any_file "${drivers[@]}" && any_file "${libraries[@]}"
}
any_file() {
  local file
  for file; do [ -e "$file" ] && return; done
  return 1
}
case $system in
  Linux) ! is_wanted vulkan || has_vulkan || apt_install "a Vulkan driver" mesa-vulkan-drivers libvulkan1 ;;
esac

# --- wasm32 target ----------------------------------------------------------------------------------------
# Debian's rustc-web (the compiler for its browsers) has the source of std, but no std for wasm32. This builds std once
# and copies it into the compiler's sysroot. embed-bitcode: for LTO; test: for cargo test.
build_debian_std() {
  apt_install "Debian's Rust compiler and the source of std" \
    rustc-web cargo-web rust-web-src rust-web-llvm rust-web-clippy gcc libc6-dev
  apt_install "the linker of that compiler's LLVM" \
    "lld-$(/usr/bin/rustc -vV | sed -n 's/^LLVM version: \([0-9]*\).*/\1/p')"
  say "building std for wasm32, once (about a minute)"
  local scratch=target/setup/std out
  out=$(/usr/bin/rustc --print sysroot)/lib/rustlib/wasm32-unknown-unknown/lib
  rm -rf "$scratch"
  mkdir -p "$scratch/src"
  printf '[package]\nname = "std-for-wasm32"\nedition = "2024"\n[workspace]\n' >"$scratch/Cargo.toml"
  : >"$scratch/src/lib.rs"
  (
    cd "$scratch"
    RUSTC_BOOTSTRAP=1 RUSTFLAGS=-Cembed-bitcode=yes RUSTC=/usr/bin/rustc CARGO_TARGET_DIR=target /usr/bin/cargo \
      build --release --target wasm32-unknown-unknown -Zbuild-std=std,panic_abort,test
  ) >target/setup/std.log 2>&1 || {
    tail -n 15 target/setup/std.log >&2
    stop "std did not build for wasm32." "The messages are above and in target/setup/std.log."
  }
  "${root[@]}" rm -rf "$out"
  "${root[@]}" mkdir -p "$out"
  "${root[@]}" cp "$scratch"/target/wasm32-unknown-unknown/release/deps/lib*.rlib "$out/"
  rm -rf "$scratch" target/wasm target/wasm-threads # files built against another std do not fit
}
by_hand="Run: rustup target add wasm32-unknown-unknown && rustup component add rust-src"
if is_wanted wasm && ! tools/wasm-cargo.sh --which >/dev/null 2>&1; then
  if has rustup && RUSTUP_MAX_RETRIES=0 within 180 rustup target add wasm32-unknown-unknown &&
    RUSTUP_MAX_RETRIES=0 within 180 rustup component add rust-src; then
    say "added the wasm32 target and the source of std to rustup's toolchain"
  elif has apt-cache && apt-get --version >/dev/null; then
    say "rustup did not bring the wasm32 target; trying Debian's compiler instead"
    build_debian_std
  else
    stop "the wasm32-unknown-unknown target, or the source of std, is missing and rustup could not add it." "$by_hand"
  fi
  tools/wasm-cargo.sh --which >/dev/null 2>&1 ||
    stop "still no compiler can compile for wasm32." "$by_hand, and read its messages"
fi

# --- npm packages -----------------------------------------------------------------------------------------
# npm keeps a copy of the lock file in node_modules. If the copy is older, packages have changed.
install_packages() { # FOLDER ARGUMENT…
  local folder=$1
  shift
  local copy=$folder/node_modules/.package-lock.json
  [ ! -e "$copy" ] || [ "$folder/package-lock.json" -nt "$copy" ] || return 0
  say "npm ci in $folder"
  npm ci --prefix "$folder" --no-audit --no-fund --loglevel=error "$@" ||
    stop "npm ci failed in $folder (see above)." "Run: npm ci --prefix $folder"
}
# Beside the build of wasm-bindgen. The install scripts of the other folders would fetch what is already there.
{
  ! is_wanted packages || install_packages .
  ! is_wanted bundlers || install_packages tests/bundlers --ignore-scripts
  ! is_wanted peers || install_packages tests/peers --ignore-scripts
} &
packages=$!

# --- wasm-bindgen -----------------------------------------------------------------------------------------
# The program must have the version of the crate. The install includes the runner of the browser tests.
wanted=$(sed -n '/^name = "wasm-bindgen"$/{n;s/^version = "\(.*\)"$/\1/p;}' Cargo.lock)
if is_wanted bindgen && [ "$(target/setup/bin/wasm-bindgen --version 2>/dev/null)" != "wasm-bindgen $wanted" ]; then
  say "building wasm-bindgen $wanted, once (about a minute)"
  mkdir -p target/setup
  # Unoptimised, wasm-bindgen builds in half the time, and still needs only half a second per module.
  CARGO_PROFILE_RELEASE_OPT_LEVEL=0 cargo install wasm-bindgen-cli --version "$wanted" --no-default-features --root target/setup \
    --target-dir target/setup/build >target/setup/wasm-bindgen.log 2>&1 || {
    tail -n 15 target/setup/wasm-bindgen.log >&2
    stop "wasm-bindgen did not build." "The messages are above and in target/setup/wasm-bindgen.log."
  }
  rm -rf target/setup/build
fi

wait "$packages"

# --- Chromium ---------------------------------------------------------------------------------------------
if is_wanted chromium && [ -z "${CHROMEDRIVER:-}" ] && ! has chromedriver; then
  if [ "$system" = Linux ] && [ -e /etc/debian_version ]; then
    apt_install "Chromium and its driver" chromium chromium-driver
  else
    stop "chromedriver is not on the PATH." "Install Chrome or Chromium and the chromedriver of the same version."
  fi
fi

# tests/browsers.mjs looks for the same programs.
has_chromium() {
  [ -n "${CHROMIUM:-}" ] || has chromium || has chromium-browser || has google-chrome ||
    [ -e "/Applications/Google Chrome.app" ]
}
if is_wanted chromium && ! has_chromium; then
  if [ "$system" = Linux ] && [ -e /etc/debian_version ]; then
    apt_install "Chromium" chromium
  else
    stop "Chromium is not on the PATH." "Install Chrome or Chromium, or set CHROMIUM to its program."
  fi
fi

# --- Firefox ----------------------------------------------------------------------------------------------
# Debian's Firefox has WebGPU since 153; older package lists have an older version.
has_firefox() {
  local program
  for program in firefox-esr firefox /Applications/Firefox.app/Contents/MacOS/firefox; do
    has "$program" || continue
    [ "$("$program" --version 2>/dev/null | grep -oE '[0-9]+' | head -n 1)" -ge 153 ]
    return
  done
  return 1
}
if is_wanted firefox && [ -z "${FIREFOX:-}" ] && ! has_firefox; then
  if [ "$system" = Linux ] && [ -e /etc/debian_version ]; then
    apt_install "Firefox 153 or newer" firefox-esr
    if ! has_firefox; then
      find_root && "${root[@]}" apt-get -q update >>target/setup/apt.log 2>&1
      apt_install "a newer Firefox" firefox-esr
    fi
    has_firefox || stop "This system's Firefox is older than 153." "Install a newer one, or set FIREFOX to its program."
  else
    stop "There is no Firefox 153 or newer." "Install Firefox, or set FIREFOX to its program."
  fi
fi
# The window of Firefox needs a display. Xvfb provides one in memory.
if is_wanted firefox && [ "$system" = Linux ] && [ -z "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ] && ! has Xvfb; then
  apt_install "a display for Firefox" xvfb
fi

say "ready: ${*:-$(rustc --version); wasm32 with $(tools/wasm-cargo.sh --which)}"
