// The method of McGuire and Hughes (section 3): every edge goes through the vertex shader,
// which moves edges that are not drawn behind the near plane.
#import <common/stroke_ink.wgsl>

fn classified(edge: EdgeGeometry, word: u32, faces: EdgeFaces, corner: u32) -> StrokeVarying {
    let line = classify_edge(word, faces, stroke.classes, object.eye_is_outside != 0u);
    let is_drawn = (line.bits & DRAWN) != 0u && line.layer == stroke.layer;
    if !is_drawn || is_passed_over(line.bits) {
        return varying_of(culled_vertex());
    }
    let shape = stroke_shape();
    return varying_of(stroke_vertex(clip_edge(edge), shape, line.bits, corner));
}
