//! Where a check is open: by sight (section 9, R19) and by the clock of section 3.

use record::Check;

/// Checks of Rules 8 and 14 to 17: after the closest point none of them is open.
pub(crate) const fn ends_at_closest(check: Check) -> bool {
    matches!(
        check,
        Check::R8Magnitude
            | Check::R8Dribble
            | Check::R8Third
            | Check::R8Time
            | Check::R14
            | Check::R15
            | Check::R16
            | Check::R17Hold
            | Check::R17May
            | Check::R17Shall
            | Check::R17Port
    )
}

/// Checks of the rules for vessels in sight of one another.
pub(crate) const fn in_sight_only(check: Check) -> bool {
    matches!(
        check,
        Check::Turn
            | Check::R13
            | Check::R14
            | Check::R15
            | Check::R16
            | Check::R17Hold
            | Check::R17May
            | Check::R17Shall
            | Check::R17Port
    )
}
