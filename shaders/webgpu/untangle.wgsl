// Untangles a mesh in the plane in rounds, before the flips of an update, with the steps of src/untangle/frame. There it
// says why what two invocations change does not overlap.
#import claims
#import history_write
#import lift
#import mesh
#import put_back
#import state

// What an invocation does.
const FORGET: u32 = 0u;
const CLAIM: u32 = 1u;
const ACT: u32 = 2u;

// The work of the rounds: how many turned triangles, if there are not too many.
fn turned_triangles() -> u32 {
    let count = history_word(TURNED);
    let needed = turned_list() + count + params.triangles / 2u;
    return select(count, 0u, needed > 2u * params.triangles || params.vertices > (1u << KEY_BITS));
}

// Half a round for an item of its work. Returns whether there is anything to do.
fn do_half(i: u32, half: u32) -> bool {
    var is_busy = false;
    if number < LIFTS {
        is_busy = lift(i, half == ACT);
    } else {
        let at = 2u * params.triangles - 1u - i;
        is_busy = atomicLoad(&claims[at]) != NONE;
        if is_busy && half == ACT {
            put(at);
        } else if is_busy {
            aim(at, half == FORGET);
        }
    }
    return is_busy;
}

fn work_of_round() -> u32 {
    var count = 3u * turned_triangles();
    if number >= LIFTS {
        count = history_word(LOOSE);
    }
    return count;
}

var<workgroup> work: u32;
var<workgroup> busy: atomic<u32>;
// The round after the present one, or NONE.
var<workgroup> following: u32;

// Half a round in a dispatch of its own.
@compute @workgroup_size(WORKGROUP_SIZE)
fn half_round(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_index) local: u32,
    @builtin(num_workgroups) groups: vec3u,
) {
    number = step_.index / 2u;
    if local == 0u {
        work = work_of_round();
    }
    let count = workgroupUniformLoad(&work);
    for (var i = id.x; i < count; i += groups.x * WORKGROUP_SIZE) {
        do_half(i, CLAIM + step_.index % 2u);
    }
}

// Invocations of the kernel below. The host sets their number for the device.
override ROUNDS_SIZE: u32 = WORKGROUP_SIZE;

// All rounds from one on, in one workgroup.
@compute @workgroup_size(ROUNDS_SIZE)
fn untangle(@builtin(local_invocation_index) local: u32) {
    if local == 0u {
        following = select(NONE, step_.index / 2u, turned_triangles() > 0u);
    }
    loop {
        // Not from the variable, of which a compiler does not know that all invocations have the same.
        let round = workgroupUniformLoad(&following);
        if round == NONE {
            break;
        }
        number = round;
        if local == 0u {
            work = work_of_round();
        }
        let count = workgroupUniformLoad(&work);
        // The last rounds have one number, so nobody may have claimed in an earlier one.
        for (var half = select(CLAIM, FORGET, round == HOME); half <= ACT; half++) {
            for (var i = local; i < count; i += ROUNDS_SIZE) {
                if do_half(i, half) && half == CLAIM {
                    atomicStore(&busy, 1u);
                }
            }
            storageBarrier();
            workgroupBarrier();
        }
        if local == 0u {
            let is_busy = atomicExchange(&busy, 0u) == 1u;
            let goes_on = is_busy || (number < LIFTS && most() < MOST);
            following = select(select(NONE, LIFTS, number < LIFTS), min(number + 1u, HOME), goes_on);
        }
    }
}
