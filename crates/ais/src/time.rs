//! Times of reports, in seconds since 1970-01-01 (the calendar is Gregorian, without leap seconds).

/// How a date is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// 2016-01-12 13:02:11.218 or 2023-01-01T00:00:00.
    YearFirst,
    /// 01/03/2024 00:00:00.
    DayFirst,
}

/// Seconds since 1970-01-01; `None` for what is no time.
pub fn seconds(text: &str, order: Order) -> Option<f64> {
    let (date, clock) = text.trim().split_once(['T', ' '])?;
    let mut parts = date.split(['-', '/']).map(str::parse::<i64>);
    let mut next = || parts.next()?.ok();
    let (first, month, last) = (next()?, next()?, next()?);
    let (year, day) = match order {
        Order::YearFirst => (first, last),
        Order::DayFirst => (last, first),
    };
    let in_range = (1970..=2200).contains(&year)
        && (1..=12).contains(&month)
        && (1..=days_of(year, month)).contains(&day)
        && parts.next().is_none();
    let mut clock = clock.trim_end_matches('Z').split(':');
    let hours: f64 = clock.next()?.parse().ok()?;
    let minutes: f64 = clock.next()?.parse().ok()?;
    let seconds: f64 = clock.next()?.parse().ok()?;
    let of_a_day = (0.0..24.0).contains(&hours)
        && (0.0..60.0).contains(&minutes)
        && (0.0..61.0).contains(&seconds)
        && clock.next().is_none();
    if !in_range || !of_a_day {
        return None;
    }
    Some(days(year, month, day) as f64 * 86_400.0 + hours * 3600.0 + minutes * 60.0 + seconds)
}

fn days_of(year: i64, month: i64) -> i64 {
    let (next_year, next_month) = if month == 12 { (year + 1, 1) } else { (year, month + 1) };
    days(next_year, next_month, 1) - days(year, month, 1)
}

/// Days since 1970-01-01. Years begin in March here, so that a leap day is the last of its year.
fn days(year: i64, month: i64, day: i64) -> i64 {
    let year = if month <= 2 { year - 1 } else { year };
    let month_from_march = (month + 9) % 12;
    let of_year = (153 * month_from_march + 2) / 5 + day - 1;
    365 * year + year / 4 - year / 100 + year / 400 + of_year - 719_468
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a day that no month has, which was read as one of the next month.
    #[test]
    fn a_day_that_the_calendar_lacks_is_none() {
        for (last, none) in [
            ("29/02/2024", "30/02/2024"),
            ("28/02/2023", "29/02/2023"),
            ("28/02/2100", "29/02/2100"),
            ("30/04/2024", "31/04/2024"),
            ("31/12/2024", "32/12/2024"),
        ] {
            let at_noon = |date: &str| seconds(&format!("{date} 12:00:00"), Order::DayFirst);
            assert!(at_noon(last).is_some(), "{last}");
            assert_eq!(at_noon(none), None, "{none}");
        }
    }

    /// Known instants: 2000-03-01 is day 11,017 and 2024-02-29 is day 19,782.
    #[test]
    fn instants_are_those_of_the_calendar() {
        for (text, order, expected_s) in [
            ("1970-01-01 00:00:00", Order::YearFirst, 0.0),
            ("2000-03-01T12:00:00", Order::YearFirst, 11_017.0 * 86_400.0 + 43_200.0),
            ("29/02/2024 00:00:01.5", Order::DayFirst, 19_782.0 * 86_400.0 + 1.5),
            ("2016-01-12 13:02:11.218", Order::YearFirst, 1_452_603_731.218),
        ] {
            let got_s = seconds(text, order).unwrap();
            assert!((got_s - expected_s).abs() < 1e-6, "{text}: {got_s}");
        }
    }

    #[test]
    fn what_is_no_time_is_none() {
        for text in ["", "Unknown", "2024-13-01 00:00:00", "2024-01-01", "2024-01-01 25:00:00"] {
            assert_eq!(seconds(text, Order::YearFirst), None, "{text}");
        }
        // a day-first date is no year-first one
        assert_eq!(seconds("29/02/2024 00:00:00", Order::YearFirst), None);
    }
}
