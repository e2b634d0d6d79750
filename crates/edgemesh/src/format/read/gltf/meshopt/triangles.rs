//! Mode 1: triangles, most of which share an edge with an earlier one.
//!
//! ```text
//! 0xe1 | a code for each triangle | data | 16 bytes: pairs of codes (the table)
//!
//! code    edge (a b)        third corner c
//! X0      edge X            next                  X < f: the edge, counted from
//! X1-Xc   edge X            vertex Y              the last one
//! Xd Xe   edge X            last - 1, last + 1
//! Xf      edge X            last + difference in data
//!         corners b and c
//! f0-fd   a is next; b, c by the pair Y of the table
//! fe      a is next; b, c by a pair in data
//! ff      a by data; b, c by a pair in data
//!         in a pair: 0 next, 1-e vertex less one, f last + difference in data
//! ```
//!
//! `next` is the first vertex that no triangle had yet, `last` the last one given by a
//! difference.

use super::varint::{difference, take_byte, take_number};

const HEADER: u8 = 0xe1;
const TABLE: usize = 16;

/// How many edges and vertices are remembered.
const REMEMBERED: usize = 16;

/// Decodes `count` triangles to their corners.
///
/// # Errors
/// Says what is wrong with the stream.
pub(super) fn decode_triangles(stream: &[u8], count: usize) -> Result<Vec<u32>, String> {
    let parts = stream.split_last_chunk::<TABLE>();
    let Some((&HEADER, rest, table)) =
        parts.and_then(|(rest, table)| rest.split_first().map(|(head, rest)| (head, rest, table)))
    else {
        return Err("it is no stream of triangles".into());
    };
    let is_wrong = |pair: &u8| pair >> 4 == 0xf || pair & 0xf == 0xf;
    if table.ends_with(&[0, 0]) && !table.iter().any(is_wrong) {
        let (codes, data) = rest.split_at_checked(count).ok_or("it ends too early")?;
        let mut decoder = Decoder { data, table, ..Decoder::new() };
        let mut corners = Vec::with_capacity(3 * count);
        for &code in codes {
            corners.extend(decoder.triangle(code)?);
        }
        return match decoder.data {
            [] => Ok(corners),
            data => Err(format!("{} bytes are left over", data.len())),
        };
    }
    Err("its table has values that are not allowed".into())
}

struct Decoder<'a> {
    data: &'a [u8],
    table: &'a [u8; TABLE],
    next: u32,
    last: u32,
    edges: Recent<[u32; 2]>,
    vertices: Recent<u32>,
}

/// The last sixteen elements.
struct Recent<T> {
    elements: [Option<T>; REMEMBERED],
    /// The place of the next element.
    at: usize,
}

impl<T: Copy> Recent<T> {
    const fn new() -> Self {
        Self { elements: [None; REMEMBERED], at: 0 }
    }

    fn push(&mut self, element: T) {
        self.elements[self.at % REMEMBERED] = Some(element);
        self.at = (self.at + 1) % REMEMBERED;
    }

    /// The element that was pushed last if `back` is 0, the one before if it is 1.
    fn get(&self, back: u8) -> Result<T, String> {
        let at = self.at + 2 * REMEMBERED - 1 - usize::from(back);
        self.elements[at % REMEMBERED]
            .ok_or_else(|| "a triangle names an edge or vertex that was not there".into())
    }
}

impl Decoder<'_> {
    const fn new() -> Self {
        let (edges, vertices) = (Recent::new(), Recent::new());
        Self { data: &[], table: &[0; TABLE], next: 0, last: 0, edges, vertices }
    }

    fn triangle(&mut self, code: u8) -> Result<[u32; 3], String> {
        match (code >> 4, code & 0xf) {
            (0xf, 0xe) => {
                let pair = self.pair_in_data()?;
                let a = self.take_next();
                self.free_triangle(a, pair)
            }
            (0xf, 0xf) => {
                let pair = self.pair_in_data()?;
                let a = self.take_index()?;
                self.free_triangle(a, pair)
            }
            (0xf, at) => {
                let pair = self.table[usize::from(at)];
                let a = self.take_next();
                self.free_triangle(a, pair)
            }
            (edge, third) => self.triangle_at_edge(edge, third),
        }
    }

    /// A triangle at an earlier edge, with a third corner.
    fn triangle_at_edge(&mut self, edge: u8, third: u8) -> Result<[u32; 3], String> {
        let [a, b] = self.edges.get(edge)?;
        let c = match third {
            0x0 => self.take_next(),
            0xd => self.set_last(self.last.wrapping_sub(1)),
            0xe => self.set_last(self.last.wrapping_add(1)),
            0xf => self.take_index()?,
            vertex => self.vertices.get(vertex)?,
        };
        self.edges.push([c, b]);
        self.edges.push([a, c]);
        if matches!(third, 0x0 | 0xd..=0xf) {
            self.vertices.push(c);
        }
        Ok([a, b, c])
    }

    /// A triangle at no edge, from its first corner and a pair of codes.
    fn free_triangle(&mut self, a: u32, pair: u8) -> Result<[u32; 3], String> {
        let (second, third) = (pair >> 4, pair & 0xf);
        let b = self.corner(second)?;
        let c = self.corner(third)?;
        self.edges.push([b, a]);
        self.edges.push([c, b]);
        self.edges.push([a, c]);
        self.vertices.push(a);
        for (code, corner) in [(second, b), (third, c)] {
            if matches!(code, 0x0 | 0xf) {
                self.vertices.push(corner);
            }
        }
        Ok([a, b, c])
    }

    fn corner(&mut self, code: u8) -> Result<u32, String> {
        match code {
            0x0 => Ok(self.take_next()),
            0xf => self.take_index(),
            vertex => self.vertices.get(vertex - 1),
        }
    }

    /// A pair of codes in the data; the pair of zeros begins a new mesh.
    fn pair_in_data(&mut self) -> Result<u8, String> {
        let pair = take_byte(&mut self.data)?;
        if pair == 0 {
            self.next = 0;
        }
        Ok(pair)
    }

    const fn take_next(&mut self) -> u32 {
        let next = self.next;
        self.next = next.wrapping_add(1);
        next
    }

    fn take_index(&mut self) -> Result<u32, String> {
        let step = difference(take_number(&mut self.data)?);
        Ok(self.set_last(self.last.wrapping_add(step)))
    }

    const fn set_last(&mut self, index: u32) -> u32 {
        self.last = index;
        index
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A table with the pairs (next, next), (vertex 1, next) and (next, vertex 2).
    const PAIRS: [u8; TABLE] = [0x00, 0x10, 0x02, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];

    fn decode(codes: &[u8], data: &[u8]) -> Result<Vec<[u32; 3]>, String> {
        let stream = [&[HEADER], codes, data, &PAIRS].concat();
        Ok(decode_triangles(&stream, codes.len())?.as_chunks().0.to_vec())
    }

    #[test]
    fn triangles_at_edges() {
        // (0 1 2) leaves the edges (1 0) (2 1) (0 2), the last one first: 0 is (0 2).
        assert_eq!(decode(&[0xf0, 0x00], &[]).unwrap(), [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(decode(&[0xf0, 0x10], &[]).unwrap(), [[0, 1, 2], [2, 1, 3]]);
        assert_eq!(decode(&[0xf0, 0x20], &[]).unwrap(), [[0, 1, 2], [1, 0, 3]]);
        // (0 2 3) leaves (3 2) and (0 3); vertex 2 is 1, because 3, 2, 1, 0 came.
        assert_eq!(decode(&[0xf0, 0x00, 0x02, 0x12], &[]).unwrap()[2..], [[0, 3, 1], [1, 3, 1]]);
    }

    #[test]
    fn corners_by_the_last_difference() {
        // ff, pair ff: all three by differences +10, -3, +1. Then last + 1, last - 1,
        // and a difference of -8.
        let data = [0xff, 20, 5, 2, 15];
        let found = decode(&[0xff, 0x0e, 0x0d, 0x0f], &data).unwrap();
        assert_eq!(found, [[10, 7, 8], [10, 8, 9], [10, 9, 8], [10, 8, 0]]);
    }

    #[test]
    fn corners_by_pairs() {
        // f1: a = 3, b = vertex 0, which is 2, c = 4. f2: a = 5, b = 6, c = vertex 1,
        // which is 3 (after 2, 3, 4).
        let found = decode(&[0xf0, 0xf1, 0xf2], &[]).unwrap();
        assert_eq!(found, [[0, 1, 2], [3, 2, 4], [5, 6, 3]]);
        // fe with the pair 1f: a = 3, b = vertex 0, c by the difference +9.
        assert_eq!(decode(&[0xf0, 0xfe], &[0x1f, 18]).unwrap()[1], [3, 2, 9]);
        // fe with the pair 00 begins again.
        assert_eq!(decode(&[0xf0, 0xfe], &[0]).unwrap(), [[0, 1, 2], [0, 1, 2]]);
        // ff with the pair 00 begins again, after a difference of +7.
        assert_eq!(decode(&[0xf0, 0xff], &[0, 14]).unwrap()[1], [7, 0, 1]);
    }

    #[test]
    fn a_vertex_that_is_read_is_not_remembered_again() {
        // (0 2 3), then 3 at the edge (0 3) again: vertex 0 stays 3, vertex 1 is 2.
        let found = decode(&[0xf0, 0x00, 0x01, 0x01], &[]).unwrap();
        assert_eq!(found[2..], [[0, 3, 2], [0, 2, 2]]);
    }

    #[test]
    fn wrong_streams_are_errors() {
        let what = |codes: &[u8], data: &[u8]| decode(codes, data).unwrap_err();
        assert!(what(&[0x00], &[]).contains("not there"));
        assert!(what(&[0xf0, 0x30], &[]).contains("not there"));
        assert!(what(&[0xf0, 0x03], &[]).contains("not there"));
        assert!(what(&[0xf0, 0x0f], &[]).contains("too early"));
        assert!(what(&[0xfe], &[]).contains("too early"));
        assert!(what(&[0xf0], &[1]).contains("1 bytes are left over"));
        let sound = [&[HEADER, 0xf0][..], &PAIRS].concat();
        assert!(decode_triangles(&sound, 1).is_ok());
        assert!(decode_triangles(&sound, 2).is_err() && decode_triangles(&sound, 0).is_err());
        assert!(decode_triangles(&sound, usize::MAX / 3).is_err());
        for (at, value) in [(0, 0xe0), (16, 1), (17, 1), (2, 0xf0), (3, 0x0f)] {
            let mut changed = sound.clone();
            changed[at] = value;
            assert!(decode_triangles(&changed, 1).is_err(), "{at}");
        }
        for end in 0..sound.len() {
            assert!(decode_triangles(&sound[..end], 1).is_err(), "{end}");
        }
    }
}
