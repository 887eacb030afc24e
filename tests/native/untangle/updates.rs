//! Updates untangle in a fixed number of rounds: most frames are right after one update, and the others after few more with
//! the same positions.

use super::motions::{Motion, Random, State, motions};
use super::oracle::{blocks, boundary, fault, obstacle};
use super::{Form, is_full, on, session};
use edgeflip::{Backend, Options, Positions};
use pollster::block_on;

/// Updates until a frame that is possible has to be right.
const MOST: usize = 12;

/// What became of the frames of a motion.
#[derive(Debug, Default)]
struct Tally {
    frames: usize,
    possible: usize,
    /// Right after the first update, the second, and so on.
    after: [usize; MOST],
    never: usize,
}

fn run(motion: &Motion, frames: usize) -> Tally {
    let form = Form::Plain;
    let mut session = session(motion, form, &on(Backend::Cpu, 1));
    let border = boundary(&motion.scene.triangles);
    let (places, triangles) = (motion.scene.places.clone(), motion.scene.triangles.clone());
    let mut state = State { frame: 0, places, triangles, random: Random(12345) };
    let mut tally = Tally::default();
    for frame in 0..frames {
        if motion.resets {
            session = super::session(motion, form, &on(Backend::Cpu, 1));
            state.places.clone_from(&motion.scene.places);
        }
        state.frame = frame;
        (motion.step)(&mut state);
        let points = form.points(&state.places);
        let locked = &motion.scene.locked;
        let numbers: Vec<f32> = form.numbers(&points).into_iter().map(|x| x as f32).collect();
        let is_possible =
            obstacle(&points, &border, form.winding()).is_none() && !blocks(&points, &border, locked);
        tally.frames += 1;
        tally.possible += usize::from(is_possible);
        for update in 0..MOST {
            session.update(Some(Positions::F32(numbers.clone())), 64).unwrap();
            let triangles = block_on(session.triangles()).unwrap();
            let name = format!("{}, frame {frame}, update {update}", motion.name);
            assert_eq!(triangles.len(), motion.scene.triangles.len(), "{name}");
            assert_eq!(boundary(&triangles), border, "{name}");
            let is_right = fault(&points, &triangles, locked, form.winding()).is_none();
            state.triangles = triangles;
            if is_right {
                tally.after[update] += usize::from(is_possible);
                break;
            }
            if !is_possible {
                break;
            }
            tally.never += usize::from(update == MOST - 1);
        }
    }
    tally
}

#[test]
fn most_frames_are_right_after_one_update() {
    let only = std::env::var("EDGEFLIP_MOTION").unwrap_or_default();
    for motion in motions(400).iter().filter(|motion| motion.name.contains(&only)) {
        let tally = run(motion, if is_full() { motion.frames } else { 60 });
        let Tally { frames, possible, after, never } = tally;
        let last = after.iter().rposition(|&count| count > 0).map_or(0, |i| i + 1);
        println!(
            "{}: {frames} frames, {possible} possible, right after {:?}, never {never}",
            motion.name,
            &after[..last]
        );
        if !SLOW.contains(&motion.name.as_str()) {
            assert_eq!(after[0], possible, "{}", motion.name);
        }
    }
}

/// Motions of which some possible frames are not right after one update: beyond several spacings, or with locked edges.
const SLOW: [&str; 7] =
    ["all move 1", "stirrer paddle", "all jump", "hole 0.2", "hole 0.4", "bar 0.35", "bar 1.5"];

/// 20,000 vertices in the full run.
#[test]
fn most_frames_of_many_vertices_are_right_after_one_update() {
    let count = if is_full() { 20_000 } else { 3000 };
    for motion in motions(count).iter().filter(|motion| motion.name.starts_with("all move")) {
        let Tally { frames, after, never, .. } = run(motion, 4);
        let last = after.iter().rposition(|&count| count > 0).map_or(0, |i| i + 1);
        println!("{}: {frames} frames, right after {:?}, never {never}", motion.name, &after[..last]);
        if !SLOW.contains(&motion.name.as_str()) {
            assert_eq!(after[0], frames, "{}", motion.name);
        }
    }
}

/// Moves the same mesh on several engines: they have the same triangles after each update.
fn compare(motion: &Motion, frames: usize, choices: &[Options]) {
    let form = Form::Plain;
    let options =
        |options: &Options| Options { track_changes: true, max_normal_angle: 180.0, ..options.clone() };
    let mut sessions: Vec<_> = choices.iter().map(|choice| session(motion, form, &options(choice))).collect();
    let (places, triangles) = (motion.scene.places.clone(), motion.scene.triangles.clone());
    let mut state = State { frame: 0, places, triangles, random: Random(12345) };
    for frame in 0..frames {
        if motion.resets && frame % 4 == 0 {
            state.places.clone_from(&motion.scene.places);
        }
        state.frame = frame;
        (motion.step)(&mut state);
        let numbers: Vec<f32> =
            form.numbers(&form.points(&state.places)).into_iter().map(|x| x as f32).collect();
        let mut first = None;
        for session in &mut sessions {
            session.update(Some(Positions::F32(numbers.clone())), [1, 4, 0, 16][frame % 4]).unwrap();
            let found = (
                block_on(session.triangles()).unwrap(),
                block_on(session.changes()).unwrap(),
                block_on(session.counters()).unwrap(),
            );
            let first = first.get_or_insert_with(|| found.clone());
            assert!(first.0 == found.0, "{}, frame {frame}: other triangles", motion.name);
            assert!(first.1 == found.1, "{}, frame {frame}: other changes", motion.name);
            assert_eq!(first.2, found.2, "{}, frame {frame}", motion.name);
        }
        state.triangles = first.unwrap().0;
    }
}

const COMPARED: [&str; 11] = [
    "drag 4",
    "all move 0.05",
    "all move 0.2",
    "all move 0.5",
    "lloyd 1.6",
    "stirrer rigid",
    "stirrer paddle",
    "boundary wave 0.2",
    "hole 0.1",
    "hole 0.2",
    "bar 0.1",
];

#[cfg(feature = "gpu")]
#[test]
fn engines_agree_in_updates() {
    let choices = [on(Backend::Cpu, 1), on(Backend::Gpu, 1)];
    let motions = motions(400);
    for motion in motions.iter().filter(|motion| COMPARED.contains(&motion.name.as_str())) {
        compare(motion, if is_full() { 100 } else { 16 }, &choices);
    }
}

#[cfg(feature = "threads")]
#[test]
fn threads_agree_in_updates() {
    let choices = [on(Backend::Cpu, 1), on(Backend::Cpu, 8)];
    let motions = motions(if cfg!(debug_assertions) { 400 } else { 40_000 });
    for motion in motions.iter().filter(|motion| COMPARED.contains(&motion.name.as_str())) {
        compare(motion, if is_full() { 100 } else { 8 }, &choices);
    }
}
