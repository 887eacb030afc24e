//! Generated meshes: the families that the tests, the benchmarks and the demo run on.
