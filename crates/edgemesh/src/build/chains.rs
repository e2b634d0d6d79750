//! Chains the edges that every view draws into polylines.
//!
//! Idea: at a vertex, a line goes on if exactly two edges of its class meet there and turn by less
//! than a limit. So each edge has at most one successor at each end, and a walk from an open end
//! (on a loop, from the first record) lists a chain. Chains are in the order of their first
//! records, links in the order of the line.
//!
//! An edge of several classes is chained by the first of [`CHAIN_CLASSES`], so that it lies in one
//! chain only.
//!
//! ```text
//!   o---o---o      two ridges that meet:     one chain
//!       |          three at one vertex:      three chains
//!       o
//! ```
//!
//! Rejected: pairing the straightest edges at a junction. It hides the junction, and the last bit
//! can decide which pair is straightest.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::edge_mesh::{
    CHAIN_CLASSES, Chain, ChainLink, Chains, EdgeFlags, EdgeRecord, chain_class_of,
};
use crate::index::{NONE, to_u32};

/// The default for the largest turn of a line at a vertex: 60 degrees. Strokes go around the
/// corners of a hexagon, but not of a square.
pub const DEFAULT_CHAIN_TURN_RAD: f64 = std::f64::consts::FRAC_PI_3;

/// Chains records; `turn_rad` is the largest turn within a chain.
pub(crate) fn chain(positions: &[[f32; 3]], records: &[EdgeRecord], turn_rad: f64) -> Chains {
    let features: Vec<u32> = (0..to_u32(records.len()))
        .into_par_iter()
        .with_min_len(1 << 14)
        .filter(|&record| records[record as usize].flags().intersects(EdgeFlags::ALWAYS_DRAWN))
        .collect();
    let input = ChainInput { positions, records, features: &features, cosine: turn_rad.cos() };
    let neighbors = input.neighbors();
    input.walk_all(&neighbors)
}

struct ChainInput<'a> {
    positions: &'a [[f32; 3]],
    records: &'a [EdgeRecord],
    /// Records of chains, ascending.
    features: &'a [u32],
    /// The cosine of the largest turn.
    cosine: f64,
}

/// For each end of each feature, `2 f` and `2 f + 1`, the end of the next feature, or [`NONE`].
type Neighbors = Vec<u32>;

impl ChainInput<'_> {
    fn record(&self, feature: u32) -> &EdgeRecord {
        &self.records[self.features[feature as usize] as usize]
    }

    fn vertex(&self, end: u32) -> u32 {
        let record = self.record(end / 2);
        if end.is_multiple_of(2) { record.v0 } else { record.v1 }
    }

    fn position(&self, end: u32) -> DVec3 {
        Vec3::from(self.positions[self.vertex(end) as usize]).as_dvec3()
    }

    fn neighbors(&self) -> Neighbors {
        let mut ends: Vec<(u32, u32, u32)> = (0..2 * to_u32(self.features.len()))
            .into_par_iter()
            .map(|end| {
                let class =
                    chain_class_of(self.record(end / 2).flags()).unwrap_or(CHAIN_CLASSES.len());
                (self.vertex(end), to_u32(class), end)
            })
            .collect();
        ends.par_sort_unstable();
        let mut neighbors = vec![NONE; ends.len()];
        for group in ends.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            if let [(_, _, a), (_, _, b)] = *group
                && a / 2 != b / 2
                && self.goes_on(a, b)
            {
                neighbors[a as usize] = b;
                neighbors[b as usize] = a;
            }
        }
        neighbors
    }

    /// Whether the line turns little enough between the ends `a` and `b`.
    fn goes_on(&self, a: u32, b: u32) -> bool {
        let into = (self.position(a) - self.position(a ^ 1)).normalize_or_zero();
        let out = (self.position(b ^ 1) - self.position(b)).normalize_or_zero();
        into.dot(out) >= self.cosine
    }

    fn walk_all(&self, neighbors: &Neighbors) -> Chains {
        let mut chains = Chains::default();
        let mut is_seen = vec![false; self.features.len()];
        chains.links.reserve(self.features.len());
        for feature in 0..to_u32(self.features.len()) {
            if is_seen[feature as usize] {
                continue;
            }
            let (start, is_loop) = start_of(feature, neighbors);
            self.walk(start, is_loop, neighbors, &mut is_seen, &mut chains);
        }
        chains
    }

    /// Lists the chain from the end `start` on.
    fn walk(
        &self,
        start: u32,
        is_loop: bool,
        neighbors: &Neighbors,
        is_seen: &mut [bool],
        chains: &mut Chains,
    ) {
        let first_link = to_u32(chains.links.len());
        let chain = to_u32(chains.chains.len());
        let mut arc = 0.0;
        let mut end = start;
        while end != NONE && !std::mem::replace(&mut is_seen[end as usize / 2], true) {
            chains.links.push(ChainLink {
                record: self.features[end as usize / 2],
                chain,
                arc_start: rounded(arc),
                is_reversed: end % 2,
            });
            arc += (self.position(end ^ 1) - self.position(end)).length();
            end = neighbors[(end ^ 1) as usize];
        }
        let flags = self.record(start / 2).flags();
        chains.chains.push(Chain {
            first_link,
            link_count: to_u32(chains.links.len()) - first_link,
            length: rounded(arc),
            is_loop: u32::from(is_loop),
            class: chain_class_of(flags).map_or(EdgeFlags::empty(), |class| CHAIN_CLASSES[class]),
        });
    }
}

#[expect(clippy::cast_possible_truncation, reason = "lengths are in 32 bits, as positions")]
const fn rounded(length: f64) -> f32 {
    length as f32
}

/// The end where the chain of `feature` begins, and whether it is a loop. A loop begins at
/// `feature`, its first record.
fn start_of(feature: u32, neighbors: &Neighbors) -> (u32, bool) {
    let mut end = 2 * feature;
    loop {
        let before = neighbors[end as usize];
        if before == NONE {
            return (end, false);
        }
        end = before ^ 1;
        if end / 2 == feature {
            return (2 * feature, true);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::{BuildOptions, build_edge_mesh};
    use crate::model::Model;
    use crate::report::Report;

    /// A flat polygon of `count` corners on a circle of radius 1.
    fn disc(count: u32) -> Chains {
        let corners: Vec<[f32; 3]> = (0..count)
            .map(|k| {
                let (y, x) = (std::f64::consts::TAU * f64::from(k) / f64::from(count)).sin_cos();
                [rounded(x), rounded(y), 0.0]
            })
            .collect();
        let polygon: Vec<u32> = (0..count).collect();
        let model = Model::from_polygons(&corners, &[&polygon]);
        build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default()).chains
    }

    #[test]
    fn a_round_boundary_is_a_loop_and_a_square_one_four_lines() {
        let round = disc(24);
        let [only] = round.chains[..] else { panic!("{round:?}") };
        assert_eq!((only.link_count, only.is_loop, only.class), (24, 1, EdgeFlags::BOUNDARY));
        let length = 48.0 * (std::f32::consts::PI / 24.0).sin();
        assert!((only.length - length).abs() < 1e-5, "{}", only.length);
        let square = disc(4);
        assert_eq!(square.chains.len(), 4);
        assert!(square.chains.iter().all(|chain| chain.is_loop == 0 && chain.link_count == 1));
    }

    #[test]
    fn links_follow_each_other_with_their_arc_lengths() {
        // A strip of three quads; its long sides are two lines of three edges.
        let positions: Vec<[f32; 3]> =
            (0..8_u8).map(|k| [f32::from(k / 2), f32::from(k % 2), 0.0]).collect();
        let quads: [&[u32]; 3] = [&[0, 2, 3, 1], &[2, 4, 5, 3], &[4, 6, 7, 5]];
        let model = Model::from_polygons(&positions, &quads);
        let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default());
        let long: Vec<&Chain> =
            mesh.chains.chains.iter().filter(|chain| chain.link_count == 3).collect();
        assert_eq!((mesh.chains.chains.len(), long.len()), (4, 2));
        for chain in long {
            let links = &mesh.chains.links[chain.link_range()];
            let arcs: Vec<f32> = links.iter().map(|link| link.arc_start).collect();
            assert_eq!((arcs, chain.length), (vec![0.0, 1.0, 2.0], 3.0));
            for pair in links.windows(2) {
                let [(_, end), (start, _)] = [pair[0], pair[1]].map(|link| {
                    let EdgeRecord { v0, v1, .. } = mesh.records[link.record as usize];
                    if link.is_reversed == 1 { (v1, v0) } else { (v0, v1) }
                });
                assert_eq!(end, start, "a polyline");
            }
        }
    }

    #[test]
    fn three_lines_that_meet_are_three_chains() {
        let positions = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]];
        let faces: [&[u32]; 4] = [&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 3, 2]];
        let model = Model::from_polygons(&positions, &faces);
        let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default());
        assert_eq!(mesh.chains.chains.len(), 6);
        assert!(mesh.chains.chains.iter().all(|chain| chain.class == EdgeFlags::RIDGE));
    }
}
