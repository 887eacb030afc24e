//! Compares the simulation with `digests.txt` and with the audit: two implementations of the same rules that share no
//! code. `EDGEFLIP_BLESS=1 cargo test --test native -- digests::` writes the file.

use crate::matrix;
use crate::meshes;
use crate::runs::rounds;
use crate::simulation::{
    Digest, Expected, Simulation, digests_path, expected, remaining_edges, simulate, simulate_with,
};
use edgeflip::families::by_name;
use edgeflip::quality::audit;
use edgeflip::{Backend, Mesh, Options, Reason};

fn at(max_normal_angle: f64) -> Options {
    Options { max_normal_angle, ..Options::default() }
}

/// Asserts that the run is finished and that the audit finds no violation.
fn assert_audited(name: &str, mesh: &Mesh, options: &Options, run: &Simulation) {
    let beta = options.max_normal_angle;
    let audit = audit(mesh, &run.triangles, options);
    assert!(audit.violations.is_empty(), "{name} {beta}: {:?}", audit.violations);
    assert_eq!(audit.remaining, run.remaining, "{name} {beta}");
    assert_eq!(audit.remaining_edges, remaining_edges(mesh, &run.triangles, options), "{name} {beta}");
    assert_eq!(run.remaining[Reason::Stopped], 0, "{name} {beta}");
}

fn run_audited(name: &str, mesh: &Mesh, options: &Options) {
    assert_audited(name, mesh, options, &simulate_with(mesh, options));
}

#[test]
fn simulation_reproduces_the_file_and_passes_the_audit() {
    let line = |(case, run): (&meshes::Case, &Simulation)| {
        assert_audited(&case.name, &case.mesh, &case.options(Backend::Cpu), run);
        Expected::new(&case.name, case.beta, run)
    };
    let lines: Vec<Expected> = matrix::simulated().map(line).collect();
    if std::env::var_os("EDGEFLIP_BLESS").is_some() {
        let text: String = lines.iter().map(|line| format!("{line}\n")).collect();
        std::fs::write(digests_path(), format!("{}\n{text}", Expected::HEADER)).unwrap();
        return;
    }
    let expected = expected();
    assert_eq!(lines.len(), expected.len(), "another number of meshes; bless digests.txt");
    for (line, expected) in lines.iter().zip(&expected) {
        assert_eq!(line, expected);
    }
}

#[test]
fn cases_have_unique_names() {
    let mut names: Vec<_> = matrix::cases().iter().map(|case| (&case.name, case.beta.to_bits())).collect();
    let cases = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), cases);
    assert!(names.iter().all(|(name, _)| !name.contains(char::is_whitespace)));
}

#[test]
fn soups_end_and_pass_the_audit() {
    for seed in 0..rounds(300) {
        let (flat, bent) = meshes::soup(seed, 3 + seed as usize % 5, seed as usize / 5 % 23);
        run_audited(&format!("soup {seed}"), &flat, &at(10.0));
        for beta in [0.0, 40.0, 90.0, 180.0] {
            run_audited(&format!("bent soup {seed}"), &bent, &at(beta));
        }
    }
}

/// The triangles are those of a valid mesh, but there are only 4 x 4 (x 4) positions: vertices are collinear or
/// coincident, and triangles fold.
#[test]
fn crushed_meshes_end_and_pass_the_audit() {
    for seed in 0..rounds(300) {
        let mut random = oorandom::Rand64::new(u128::from(seed));
        let mut crush =
            |mesh: Mesh| meshes::moved(&mesh, |_| [(); 3].map(|()| random.rand_range(0..4) as f32));
        let n = 3 + seed as usize % 5;
        let family = |name: &str| by_name(&format!("{name} {n} seed={seed}")).unwrap();
        let (disc, sphere) = (crush(family("random")), crush(family("uvsphere")));
        run_audited(&format!("crushed disc {seed}"), &disc, &at(10.0));
        for beta in [0.0, 90.0, 135.0, 180.0] {
            run_audited(&format!("crushed sphere {seed}"), &sphere, &at(beta));
        }
    }
}

#[test]
fn strips_flip_as_in_the_paper() {
    let strips = by_name("strips 8").unwrap();
    let run = simulate(&strips, 10.0, None);
    let flips: Vec<_> = run.iterations.iter().map(|record| record.flips).collect();
    assert_eq!(flips, [1, 2, 3, 2, 1]);
}

/// `tests/package/threads.test.mjs` has the same digest.
#[test]
fn a_large_mesh_in_random_order() {
    let run = simulate(&by_name("shuffled random 260").unwrap(), 10.0, None);
    let mut end = Digest::default();
    end.feed(&run.triangles);
    assert_eq!(end.to_string(), "b84ed3d4281f2ddc");
}

#[test]
fn a_capped_run_says_what_it_left() {
    let mesh = by_name("random 12").unwrap();
    let whole = simulate(&mesh, 10.0, None);
    let capped = simulate(&mesh, 10.0, Some(2));
    assert_eq!(capped.iterations.len(), 2);
    assert_eq!(capped.digest, whole.iterations[1].digest);
    assert_eq!(capped.remaining[Reason::Stopped], u64::from(whole.iterations[2].labelled));
    let audit = audit(&mesh, &capped.triangles, &Options::default());
    assert_eq!(audit.remaining, capped.remaining);
    assert_eq!(audit.remaining_edges, remaining_edges(&mesh, &capped.triangles, &Options::default()));
    assert_eq!(audit.remaining_for(Reason::Stopped).count() as u64, capped.remaining.total());
    assert_eq!(simulate(&mesh, 10.0, Some(0)).triangles, mesh.triangles());
}

#[test]
fn a_flat_surface_flips_like_the_plane() {
    let mesh = by_name("random 20").unwrap();
    let plane = simulate(&mesh, 10.0, None);
    for beta in [0.0, 180.0] {
        assert_eq!(simulate(&meshes::lifted(&mesh, |_, _| 3.0), beta, None).digest, plane.digest);
    }
}
