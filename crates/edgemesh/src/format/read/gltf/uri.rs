//! URIs of buffers and images.
//!
//! Based on: RFC 2397 (data URIs) and RFC 3986 (schemes and percent signs).
//!
//! A URI with a scheme other than `data` is never opened. Rejected: the crate
//! `percent-encoding`, which leaves a malformed percent sign as it is instead of
//! reporting it.

use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

/// With or without padding: RFC 2397 requires it, but some programs omit it.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// What a URI refers to.
pub(super) enum UriTarget {
    /// The bytes in a data URI.
    Bytes(Vec<u8>),
    /// A path relative to the model's folder.
    Path(String),
}

/// Resolves a URI, without opening a file.
///
/// # Errors
/// Fails if the URI is malformed, or refers to something else than a local file. The
/// message follows the name of the URI in a sentence.
pub(super) fn resolve(uri: &str) -> Result<UriTarget, String> {
    match scheme(uri) {
        Some(name) if name.eq_ignore_ascii_case("data") => data_uri(uri).map(UriTarget::Bytes),
        Some(_) => Err("is not a relative path and was not opened; put the file beside the model \
                        and use its name alone"
            .into()),
        None => unescape(uri).map(UriTarget::Path),
    }
}

/// The scheme of a URI, before its colon; `None` for a relative one.
fn scheme(uri: &str) -> Option<&str> {
    let (scheme, _) = uri.split_once(':')?;
    let is_allowed = |letter: char| letter.is_ascii_alphanumeric() || "+-.".contains(letter);
    scheme.chars().all(is_allowed).then_some(scheme)
}

/// The bytes in a URI such as `data:application/octet-stream;base64,AAAA`.
///
/// # Errors
/// Fails if the URI is malformed; the message follows its name in a sentence.
fn data_uri(uri: &str) -> Result<Vec<u8>, String> {
    let Some((kind, data)) = uri.split_once(',') else {
        return Err("is a data URI without a comma".into());
    };
    if !kind.to_ascii_lowercase().ends_with(";base64") {
        return unescape_bytes(data.as_bytes());
    }
    let decoded = match data.contains('%') {
        true => BASE64.decode(unescape_bytes(data.as_bytes())?),
        false => BASE64.decode(data),
    };
    decoded.map_err(|error| format!("is not valid base64 ({error}); export the model again"))
}

/// A relative URI as a path, without percent signs.
fn unescape(uri: &str) -> Result<String, String> {
    let bytes = unescape_bytes(uri.as_bytes())?;
    String::from_utf8(bytes).map_err(|_| "does not decode to UTF-8".into())
}

/// Decodes percent signs: `%41` becomes `A`.
fn unescape_bytes(text: &[u8]) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text;
    while let Some((&byte, after)) = rest.split_first() {
        rest = after;
        if byte != b'%' {
            bytes.push(byte);
            continue;
        }
        let Some((&[high, low], after)) = rest.split_first_chunk() else {
            return Err("ends in a percent sign".into());
        };
        let digit = |letter: u8| char::from(letter).to_digit(16).and_then(|d| u8::try_from(d).ok());
        let (Some(high), Some(low)) = (digit(high), digit(low)) else {
            return Err("has a percent sign without two hexadecimal digits".into());
        };
        bytes.push(16 * high + low);
        rest = after;
    }
    Ok(bytes)
}
