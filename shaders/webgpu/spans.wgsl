// Collects the span of all points while a mesh moves.
#import history_write
#import moving
#import state

var<workgroup> highest: atomic<u32>;
var<workgroup> depth: atomic<u32>;

// Adds the spans that the invocations of a workgroup have seen. The largest of all is the same in every order.
fn add_span(span: vec2u, local: u32) {
    if params.update > 0u {
        atomicMax(&highest, span.x);
        atomicMax(&depth, span.y);
    }
    workgroupBarrier();
    if params.update > 0u && local == 0u {
        atomicMax(&history[HIGHEST], atomicLoad(&highest));
        atomicMax(&history[DEPTH], atomicLoad(&depth));
    }
}
