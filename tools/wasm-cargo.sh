#!/usr/bin/env bash
# Cargo for the wasm32 build: `tools/wasm-cargo.sh build --lib --target wasm32-unknown-unknown …`
#
# Two toolchains may be on a machine: the one on the PATH (rustup's), with or without the wasm32 target, and
# Debian's in /usr/bin, for which tools/setup.sh builds the target where rustup's server is out of reach.
# This takes the first whose compiler can compile a line of std for wasm32, which also catches a std that a
# newer compiler has left behind, and has the source of std, for `--threads`. Its own target directory keeps the two from rebuilding each other's crates.
# `tools/wasm-cargo.sh --which` names the compiler found, and fails when there is none.
# `tools/wasm-cargo.sh --threads build …` builds for instances that share their memory, std with it.
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
  # Cargo looks for cargo-clippy along the PATH, but in its own home first unless the PATH names that too.
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
# To build std, and flags of tools/build.mjs, are things of nightly compilers, unless they are told that this is known.
# Always told, since some build scripts run again where this changes.
export RUSTC_BOOTSTRAP=1
# Cargo calls the library's file edgeflip.wasm with any features, so that each module would overwrite the last one and be
# compiled again every time. With this its name has a hash, as the names of other crates' files have.
export __CARGO_DEFAULT_LIB_METADATA=edgeflip
# Vectors; tools/build.mjs says who has them.
export RUSTFLAGS="-C target-feature=+simd128 ${RUSTFLAGS:-}"
if [ "${1:-}" = --threads ]; then
  shift
  # What wasm-bindgen wants of a module whose memory, of 4 GiB at most, is shared.
  link=(--shared-memory --import-memory --max-memory=4294967296 --export=__heap_base --export=__wasm_init_tls
    --export=__tls_base --export=__tls_size --export=__tls_align)
  RUSTFLAGS+=" -C target-feature=+atomics ${link[*]/#/-C link-arg=}"
  # The std that comes with the compiler has no atomics.
  export CARGO_UNSTABLE_BUILD_STD=std,panic_abort
fi
exec cargo "$@"
