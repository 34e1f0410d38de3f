//! The coefficients of a bearing: `{ xx, yy, xy, yx }`.

use super::super::Planar;
use super::super::dimension::Dimension;
use super::super::document::Table;

/// yy defaults to xx, cross terms to zero, an absent table to nothing.
pub(super) fn planar(bearing: &Table<'_, '_>, key: &'static str, kind: &Dimension) -> Planar {
    let Some(table) = bearing.table(key) else {
        return Planar::ZERO;
    };
    let xx = table.number("xx", kind);
    let planar = Planar {
        xx,
        xy: table.number_or("xy", kind, 0.0),
        yx: table.number_or("yx", kind, 0.0),
        yy: table.number_or("yy", kind, xx),
    };
    table.finish();
    planar
}
