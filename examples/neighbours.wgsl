// Finds the points within RADIUS of a point by walks over a Delaunay triangulation. The program defines RADIUS;
// `place`, the point of a vertex; and the buffers `indices`, `twins` and `half_edges` of a session with the option
// `adjacency`.
//
// Edges inside a disc join all points of the disc, if the triangulation has a convex outline: for two points p and q,
// take a disc inside it that has both on its circle. If no point is inside that one, pq is an edge, or edges along the
// circle join p and q. Else there is a point s inside it, and p and s, as well as s and q, have smaller such discs.

const NONE = 0xffffffffu;
// The most points that a search keeps.
const MOST = 96u;

// The points of a search, the first one at its centre.
var<private> found: array<u32, MOST>;

fn next(h: u32) -> u32 {
    return select(h + 1u, h - 2u, h % 3u == 2u);
}

fn prev(h: u32) -> u32 {
    return select(h - 1u, h + 2u, h % 3u == 0u);
}

// Whether a point is a neighbour, by the way to it. In whole numbers, so that all kernels decide alike.
fn is_near(way: vec2f) -> bool {
    let whole = vec2i(way * (16384 / RADIUS));
    return all(abs(whole) <= vec2i(16384)) && dot(whole, whole) <= 268435456;
}

// Finds the neighbours of a vertex, and points that are a little further away. Returns how many, with the vertex
// itself; more than MOST if some are lost.
fn search(centre: u32) -> u32 {
    let middle = place(centre);
    found[0] = centre;
    var count = 1u;
    for (var i = 0u; i < min(count, MOST); i++) {
        let start = half_edges[found[i]];
        var h = start;
        while h != NONE {
            count = visited(indices[next(h)], middle, count);
            let last = prev(h);
            h = twins[last];
            if h == NONE {
                // On the boundary, the star ends with the edge of one triangle.
                count = visited(indices[last], middle, count);
            }
            if h == start {
                break;
            }
        }
    }
    return count;
}

// Keeps a vertex of the search around a point, unless it is kept already. Returns the number of points.
fn visited(v: u32, middle: vec2f, count: u32) -> u32 {
    let way = place(v) - middle;
    // Rounding must not part a neighbour from the others.
    if dot(way, way) > 1.01 * RADIUS * RADIUS {
        return count;
    }
    for (var i = 0u; i < min(count, MOST); i++) {
        if found[i] == v {
            return count;
        }
    }
    if count < MOST {
        found[count] = v;
    }
    return count + 1u;
}
