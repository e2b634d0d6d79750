//! Small files for tests.

use std::io::Write as _;

use flate2::write::DeflateEncoder;
use flate2::{Compression, Crc};

use super::super::error::ReadError;
use super::super::source::Source;
use super::read_3mf;
use crate::model::Model;
use crate::report::Report;

/// How the parts of an archive are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Packing {
    Stored,
    Deflated,
    /// Stored, with sizes and offsets of 64 bits.
    Wide,
}

/// An archive of parts with these names and contents.
pub(super) fn zip(parts: &[(&str, &[u8])], packing: Packing) -> Vec<u8> {
    let (mut file, mut directory) = (Vec::new(), Vec::new());
    for (name, content) in parts {
        let offset = file.len();
        let data = packed(content, packing);
        let mut checksum = Crc::new();
        checksum.update(content);
        let method = u16::from(packing == Packing::Deflated) * 8;
        let sizes = [u32(data.len()), u32(content.len())].concat();
        let common = [&checksum.sum().to_le_bytes()[..], &sizes, &u16(name.len())].concat();
        // Version 2.0, no flags, no date.
        let start = [&[20, 0, 0, 0][..], &method.to_le_bytes(), &[0; 4]].concat();
        file.extend([b"PK\x03\x04", &start[..], &common, &[0, 0], name.as_bytes(), &data].concat());
        let mut extra = Vec::new();
        let mut record = [&[20, 0][..], &start, &common].concat();
        let mut place = u32(offset);
        if packing == Packing::Wide {
            let wide = [content.len(), data.len(), offset];
            extra.extend([1, 0, 24, 0]);
            extra.extend(wide.iter().flat_map(|&number| (number as u64).to_le_bytes()));
            record[16..24].fill(0xff);
            place.fill(0xff);
        }
        directory.extend(b"PK\x01\x02");
        directory.extend(record);
        directory.extend([&u16(extra.len())[..], &[0; 10], &place].concat());
        directory.extend(name.as_bytes());
        directory.extend(extra);
    }
    let start = file.len();
    let size = directory.len();
    file.extend(directory);
    let (mut count, mut place) = (u16(parts.len()), u32(start));
    if packing == Packing::Wide {
        let end = file.len() as u64;
        file.extend([&b"PK\x06\x06"[..], &44_u64.to_le_bytes(), &[0; 12]].concat());
        for number in [parts.len(), parts.len(), size, start] {
            file.extend((number as u64).to_le_bytes());
        }
        file.extend([&b"PK\x06\x07"[..], &[0; 4], &end.to_le_bytes(), &[1, 0, 0, 0]].concat());
        count.fill(0xff);
        place.fill(0xff);
    }
    file.extend([b"PK\x05\x06", &[0; 4][..], &count, &count, &u32(size), &place, &[0, 0]].concat());
    file
}

fn packed(content: &[u8], packing: Packing) -> Vec<u8> {
    if packing != Packing::Deflated {
        return content.to_vec();
    }
    let mut encoder = DeflateEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(content).unwrap();
    encoder.finish().unwrap()
}

fn u16(number: usize) -> [u8; 2] {
    u16::try_from(number).unwrap().to_le_bytes()
}

fn u32(number: usize) -> [u8; 4] {
    u32::try_from(number).unwrap().to_le_bytes()
}

/// The start of a model part with the namespaces of all supported extensions.
pub(super) const MODEL: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<model xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
 xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02"
 xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06""#;

/// A model part: its resources begin in line 5.
pub(super) fn model_part(resources: &str, items: &str) -> String {
    format!("{MODEL}>\n<resources>{resources}</resources>\n<build>{items}</build>\n</model>")
}

/// Four vertices of a unit square.
pub(super) const VERTICES: &str = r#"<vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="1" y="1" z="0"/><vertex x="0" y="1" z="0"/></vertices>"#;

/// An object that is a square of two triangles, with more attributes.
pub(super) fn square(attributes: &str) -> String {
    format!(
        r#"<object {attributes}><mesh>{VERTICES}<triangles><triangle v1="0" v2="1" v3="2"/><triangle v1="0" v2="2" v3="3"/></triangles></mesh></object>"#
    )
}

/// Reads an archive of parts with these names and texts.
pub(super) fn read_parts(parts: &[(&str, &str)]) -> Result<(Model, Report), ReadError> {
    let parts: Vec<(&str, &[u8])> =
        parts.iter().map(|(name, text)| (*name, text.as_bytes())).collect();
    let bytes = zip(&parts, Packing::Deflated);
    let mut report = Report::default();
    let source = Source { name: "test.3mf", folder: None, bytes: &bytes };
    let model = read_3mf(&source, &mut report)?;
    Ok((model, report))
}

/// Reads a file with one model part at the usual place.
pub(super) fn read(resources: &str, items: &str) -> Result<(Model, Report), ReadError> {
    read_parts(&[("3D/3dmodel.model", &model_part(resources, items))])
}
