// While a mesh moves, the host does not see its positions. The device finds out whether some edge has to be left alone.
#import left_alone if floats
#import state
#import still if fixed

fn leaves_some() -> bool {
    return params.update > 0u && is_too_wide(vec2u(params.highest, params.depth));
}
