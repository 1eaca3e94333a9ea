//! Land, piers and shoals in a file: polygons that must be simple.

use crate::Error;
use crate::error::require;
use geom::Vec2;

/// Corners, two numbers each, metres.
pub type Polygon = Vec<[f64; 2]>;

/// Refuses what is no simple polygon; `key` is where the list stands.
pub(crate) fn validate_hazards(key: &str, hazards: Option<&Vec<Polygon>>) -> Result<(), Error> {
    let hazards = hazards.map_or(&[][..], Vec::as_slice);
    require(
        hazards.len() <= usize::from(u8::MAX),
        || key.to_owned(),
        || format!("has {} polygons; at most 255 can be told apart", hazards.len()),
    )?;
    for (i, polygon) in hazards.iter().enumerate() {
        if let Some(fault) = geom::polygon::fault(&corners(polygon, 0.0)) {
            return Err(Error::spec(format!("{key}.{}", i + 1), fault.to_string()));
        }
    }
    Ok(())
}

/// The corners, turned by own course.
pub(crate) fn corners(polygon: &[[f64; 2]], own_psi_rad: f64) -> Vec<Vec2> {
    let place = |&[ahead_m, starboard_m]: &[f64; 2]| Vec2::new(ahead_m, starboard_m);
    if own_psi_rad.abs() <= 0.0 {
        return polygon.iter().map(place).collect();
    }
    polygon.iter().map(|corner| geom::angle::rotate(place(corner), own_psi_rad)).collect()
}
