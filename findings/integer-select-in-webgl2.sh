#!/usr/bin/env bash
# One expects: naga, asked for GLSL ES 3.00, either writes a shader that WebGL2 takes or returns an error.
# What happens: `select` of vectors of integers by a vector of booleans becomes `mix`, which GLSL ES 3.00 has only for
# floats (integers came with 3.10). The module is valid, naga returns no error, and the shader does not compile. The
# same line with floats is right in 3.00.
# Why it matters: nothing that runs before the browser sees it, and WebGL2 has no 3.10 to ask for. Where the condition
# is one boolean, naga writes ?:, which is right, so the two look alike in WGSL and one of them fails. The browsers'
# messages name lines of GLSL that nobody wrote. Open as gfx-rs/wgpu#10093.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init -y >npm.log
npm install --no-audit --no-fund glslang-validator-prebuilt-predownloaded@0.0.2 >>npm.log 2>&1
mkdir src
cat >Cargo.toml <<'TOML'
[package]
name = "translate"
version = "0.0.0"
edition = "2024"

[dependencies]
naga = { version = "=30.0.1", features = ["wgsl-in", "glsl-out"] }
TOML
cat >src/main.rs <<'RS'
use naga::back::glsl::{Options, PipelineOptions, Version, Writer};
use naga::proc::BoundsCheckPolicies;
use naga::valid::{Capabilities, ValidationFlags, Validator};

/// Prints the GLSL ES of version `arg 1` for a fragment shader whose body is `arg 2` and whose colour is of type `arg 3`.
fn main() {
    let [version, body, colour] = [1, 2, 3].map(|n| std::env::args().nth(n).expect("three arguments"));
    let wgsl = format!(
        "@fragment fn main(@builtin(position) at: vec4f) -> @location(0) {colour} {{ let a = {colour}(at); {body} }}"
    );
    let module = naga::front::wgsl::parse_str(&wgsl).expect("valid WGSL");
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module).expect("a valid module");
    let options = Options { version: Version::new_gles(version.parse().expect("a version")), ..Options::default() };
    let entry =
        PipelineOptions { shader_stage: naga::ShaderStage::Fragment, entry_point: "main".into(), multiview: None };
    let mut glsl = String::new();
    Writer::new(&mut glsl, &module, &info, &options, &entry, BoundsCheckPolicies::default())
        .and_then(|mut writer| writer.write())
        .expect("naga returns no error");
    print!("{glsl}");
}
RS
cargo build --quiet
compiler=node_modules/glslang-validator-prebuilt-predownloaded/bin/glslangValidator.linux
chmod +x "$compiler"
echo "naga 30.0.1, $("$compiler" -v | head -1)"

# compiles VERSION BODY TYPE: whether the shader that naga writes compiles.
compiles() {
  target/debug/translate "$@" >shader.frag
  "$compiler" shader.frag >compiler.log 2>&1
}
status=0
expect() {
  local wanted=$1 got=compiles
  compiles "${@:2}" || got=fails
  echo "GLSL ES $2, $4: $3"
  echo "  $got: $(grep -o '= .*[(?].*' shader.frag | tail -1)"
  grep -m1 ERROR compiler.log || true
  [ "$got" = "$wanted" ] || { echo "  but it was seen to be: $wanted"; status=1; }
}
expect fails 300 'return select(a, a.wzyx, a > vec4u(7));' vec4u
expect fails 300 'return select(a, a.wzyx, a > vec4i(7));' vec4i
expect compiles 300 'return select(a, a.wzyx, a.x > 7);' vec4u
expect compiles 300 'return select(a, a.wzyx, a > vec4f(7));' vec4f
expect compiles 310 'return select(a, a.wzyx, a > vec4u(7));' vec4u
exit $status
