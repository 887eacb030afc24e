#!/usr/bin/env bash
# Cargo for the wasm32 build: `tools/wasm-cargo.sh build --lib --target wasm32-unknown-unknown …`
#
# A machine may have two toolchains: the one on the PATH (rustup's), with or without the wasm32 target, and
# Debian's in /usr/bin, for which tools/setup.sh builds the target if rustup's server is out of reach.
# This script takes the first toolchain that has the source of std, which `--threads` needs, and whose compiler can
# compile a line of Rust for wasm32. Its compiler cannot if the std for wasm32 belongs to an older compiler. The script
# has its own target directories, so that its builds and the native build do not rebuild each other's crates.
# `tools/wasm-cargo.sh --which` prints the compiler, and fails if there is none.
# `tools/wasm-cargo.sh --threads build …` builds the crate and std for instances that share their memory.
set -euo pipefail
cd "$(dirname "$0")/.."

compiles_wasm() { # RUSTC
  [ -e "$("$1" --print sysroot)/lib/rustlib/src/rust/library/std/Cargo.toml" ] || return
  mkdir -p target/setup
  echo 'pub fn probe() -> String { String::new() }' |
    "$1" --target wasm32-unknown-unknown --crate-name probe --crate-type lib --emit metadata \
      --out-dir target/setup - 2>/dev/null
}

if command -v rustc >/dev/null && compiles_wasm rustc; then
  compiler=rustc
elif [ -x /usr/bin/cargo ] && [ -x /usr/bin/rustc ] && compiles_wasm /usr/bin/rustc; then
  compiler=/usr/bin/rustc
  export RUSTC=/usr/bin/rustc RUSTDOC=/usr/bin/rustdoc
  # Cargo looks for cargo-clippy in its own home before the PATH, unless the PATH contains that home too.
  export PATH="/usr/bin:$PATH:${CARGO_HOME:-$HOME/.cargo}/bin"
else
  echo "wasm-cargo: no Rust compiler here has the wasm32-unknown-unknown target and the source of std; run tools/setup.sh" >&2
  exit 1
fi

if [ "${1:-}" = --which ]; then
  echo "$(command -v "$compiler") ($("$compiler" --version))"
  exit
fi
export CARGO_TARGET_DIR="$PWD/target/wasm"
# Allows a stable compiler to build std and to take the unstable flags of tools/build.mjs. Always set, because some
# build scripts run again if it changes.
export RUSTC_BOOTSTRAP=1
# Cargo names the library's file edgeflip.wasm for all features, so each module would overwrite the previous one and be
# compiled again every time. With this variable the name has a hash, like the file names of other crates.
export __CARGO_DEFAULT_LIB_METADATA=edgeflip
# SIMD; tools/build.mjs says which browsers have it.
export RUSTFLAGS="-C target-feature=+simd128 ${RUSTFLAGS:-}"
if [ "${1:-}" = --threads ]; then
  shift
  # The linker flags that wasm-bindgen needs for a module with shared memory, of 4 GiB at most.
  link=(--shared-memory --import-memory --max-memory=4294967296 --export=__heap_base --export=__wasm_init_tls
    --export=__tls_base --export=__tls_size --export=__tls_align)
  RUSTFLAGS+=" -C target-feature=+atomics ${link[*]/#/-C link-arg=}"
  # The prebuilt std of the compiler has no atomics.
  export CARGO_UNSTABLE_BUILD_STD=std,panic_abort
  # It shares no crate with the other builds, so it can run beside them.
  export CARGO_TARGET_DIR="$PWD/target/wasm-threads"
fi
exec cargo "$@"
