//! The names of the judge's checks, one for each file of `rules`.

use serde::{Deserialize, Serialize};

macro_rules! checks {
    ($($(#[$doc:meta])* $variant:ident = $name:literal, $title:literal;)*) => {
        /// A check of the judge.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
        #[repr(u8)]
        pub enum Check { $($(#[$doc])* #[serde(rename = $name)] $variant,)* }

        impl Check {
            /// Every check, in the order of reports.
            pub const ALL: [Self; Self::COUNT] = [$(Self::$variant,)*];
            /// How many there are.
            pub const COUNT: usize = [$($name,)*].len();

            /// The word used in files and column names.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)* }
            }

            /// What a reader of a report sees.
            pub const fn title(self) -> &'static str {
                match self { $(Self::$variant => $title,)* }
            }

            /// The check with this name.
            pub fn from_name(name: &str) -> Option<Self> {
                Self::ALL.into_iter().find(|check| check.name() == name)
            }
        }
    };
}

impl Check {
    /// What the check needs beside the voyage and cannot do without: where it is missing the check
    /// is not evaluated.
    pub const fn needs(self) -> Option<&'static str> {
        match self {
            Self::R5R7 => Some("alerts that the planner declares"),
            Self::R6 | Self::R19Speed => Some("a declared stopping model of own ship"),
            Self::LastMinute => Some("the extra runs of the last-minute search"),
            _ => None,
        }
    }
}

checks! {
    /// Minimum passing distance (Rules 8(d) and 16).
    Safe = "safe", "Passing distance (Rule 8(d))";
    /// Rule-consistent turn direction, the headline check.
    Turn = "turn", "Turn direction";
    /// Look-out and risk, from what track data can show.
    R5R7 = "r5_r7", "Look-out and risk (Rules 5 and 7)";
    /// Safe speed, where a stopping model is declared.
    R6 = "r6", "Safe speed (Rule 6)";
    /// Large enough to be readily apparent.
    R8Magnitude = "r8_magnitude", "Readily apparent (Rule 8(b))";
    /// No succession of small alterations.
    R8Dribble = "r8_dribble", "No dribble (Rule 8(b))";
    /// No close quarters with a third ship.
    R8Third = "r8_third", "No third ship endangered (Rule 8(c))";
    /// Made in ample time.
    R8Time = "r8_time", "Ample time (Rule 8(a))";
    /// Overtaking: keeping out of the way until past and clear.
    R13 = "r13", "Overtaking (Rule 13)";
    /// Head-on: altering to starboard, passing port to port.
    R14 = "r14", "Head-on (Rule 14)";
    /// Crossing: not crossing ahead.
    R15 = "r15", "Crossing (Rule 15)";
    /// Give-way: early and substantial.
    R16 = "r16", "Give-way (Rule 16)";
    /// Stand-on: keeps course and speed.
    R17Hold = "r17ai", "Stand-on holds (Rule 17(a)(i))";
    /// Stand-on: may act.
    R17May = "r17aii", "Stand-on may act (Rule 17(a)(ii))";
    /// Stand-on: shall act.
    R17Shall = "r17b", "Stand-on shall act (Rule 17(b))";
    /// Stand-on: not to port for a ship on the port side.
    R17Port = "r17c", "Stand-on not to port (Rule 17(c))";
    /// Restricted visibility.
    R19 = "r19", "Restricted visibility (Rule 19)";
    /// Safe speed in restricted visibility, where a stopping model is declared.
    R19Speed = "r19b", "Safe speed in restricted visibility (Rule 19(b))";
    /// Margin to the last safe instant.
    LastMinute = "last_minute", "Last-minute margin";
}
