//! Between the types of `planner-api` and those of the messages.
//!
//! Every field is named, so that a new one cannot be forgotten.

use crate::wire::{Alert, Mission, Number, Order, OrderAnswer, Own, OwnShip, Track, Waypoint};
use geom::Vec2;
use planner_api as api;

const fn pair(v: Vec2) -> [f64; 2] {
    let [[north, east]] = v.data.0;
    [north, east]
}

impl From<&api::Mission> for Mission {
    fn from(mission: &api::Mission) -> Self {
        let api::Mission {
            own,
            route,
            cruise_mps,
            safety_radius_m,
            between_centres,
            beat_s,
            hazards,
            stream_seed,
        } = mission;
        let api::OwnShip {
            length_m,
            beam_m,
            speed_mps_max,
            yaw_rate_radps_max,
            acceleration_mps2_max,
        } = *own;
        Self {
            own: OwnShip {
                length_m,
                beam_m,
                speed_mps_max,
                yaw_rate_radps_max,
                acceleration_mps2_max,
            },
            route: route
                .iter()
                .map(|&api::Waypoint { position_m, speed_mps }| Waypoint {
                    position_m: pair(position_m),
                    speed_mps,
                })
                .collect(),
            cruise_mps: *cruise_mps,
            safety_radius_m: *safety_radius_m,
            between_centres: *between_centres,
            beat_s: *beat_s,
            hazards: hazards.iter().map(|h| h.iter().map(|&c| pair(c)).collect()).collect(),
            stream_seed: format!("{stream_seed:016x}"),
        }
    }
}

impl From<api::OwnState> for Own {
    fn from(own: api::OwnState) -> Self {
        let api::OwnState {
            position_m,
            psi_rad,
            velocity_mps,
            cog_rad,
            sog_mps,
            stw_mps,
            yaw_rate_radps,
        } = own;
        Self {
            position_m: pair(position_m),
            psi_rad,
            velocity_mps: pair(velocity_mps),
            cog_rad,
            sog_mps,
            stw_mps,
            yaw_rate_radps,
        }
    }
}

impl From<api::TargetTrack> for Track {
    fn from(track: api::TargetTrack) -> Self {
        let api::TargetTrack {
            id,
            position_m,
            velocity_mps,
            cog_rad,
            sog_mps,
            psi_rad,
            length_m,
            beam_m,
            covariance,
            age_s,
            since_update_s,
        } = track;
        Self {
            id,
            position_m: pair(position_m),
            velocity_mps: pair(velocity_mps),
            cog_rad,
            sog_mps,
            psi_rad,
            length_m,
            beam_m,
            covariance,
            age_s,
            since_update_s,
        }
    }
}

impl From<OrderAnswer> for api::Command {
    fn from(answer: OrderAnswer) -> Self {
        let order = match answer.order {
            Order::CourseSpeed { course_rad: Number(course_rad), speed_mps: Number(speed_mps) } => {
                api::Order::CourseSpeed { course_rad, speed_mps }
            }
            Order::VelocityMps([Number(north), Number(east)]) => {
                api::Order::Velocity { velocity_mps: Vec2::new(north, east) }
            }
        };
        let alerts = answer.alerts.into_iter();
        let alerts = alerts.map(|Alert { track, rule, why }| api::Alert { track, rule, why });
        Self { order, alerts: alerts.collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// Every field under its name, 64 bits of seed, and the last digit of every number.
    #[test]
    fn messages_carry_what_the_planner_contract_carries() {
        let third = 1.0 / 3.0;
        let mission = api::Mission {
            own: api::OwnShip {
                length_m: 8.45,
                beam_m: 2.71,
                speed_mps_max: third,
                yaw_rate_radps_max: 0.2,
                acceleration_mps2_max: 0.5,
            },
            route: vec![
                api::Waypoint { position_m: Vec2::new(1.0, -2.5), speed_mps: Some(3.0) },
                api::Waypoint { position_m: Vec2::new(1e-7, 5e20), speed_mps: None },
            ],
            cruise_mps: 7.0,
            safety_radius_m: 150.0,
            between_centres: true,
            beat_s: 0.5,
            hazards: vec![vec![Vec2::new(0.0, third), Vec2::new(8.0, 0.0), Vec2::new(8.0, -9.0)]],
            stream_seed: 0xfedc_ba98_7654_3210,
        };
        let wire = Mission::from(&mission);
        let mut expected = serde_json::to_value(&mission).unwrap();
        assert_eq!(expected["stream_seed"], json!("fedcba9876543210"));
        assert_eq!(serde_json::to_value(&wire).unwrap(), expected);
        expected["cruise_mps"] = json!(0);
        assert_ne!(serde_json::to_value(&wire).unwrap(), expected);
        let text = serde_json::to_string(&wire).unwrap();
        assert!(text.contains("\"speed_mps_max\":0.3333333333333333,"), "{text}");

        let own = api::OwnState {
            position_m: Vec2::new(1.0, 2.0),
            psi_rad: 3.0,
            velocity_mps: Vec2::new(4.0, 5.0),
            cog_rad: 6.0,
            sog_mps: 7.0,
            stw_mps: 8.0,
            yaw_rate_radps: 9.0,
        };
        let same = |wire: serde_json::Value, api: serde_json::Value| assert_eq!(wire, api);
        same(json!(Own::from(own)), json!(own));
        let mut covariance = [[0.0; 4]; 4];
        covariance[0][3] = third;
        let track = api::TargetTrack {
            id: u32::MAX,
            position_m: Vec2::new(1.0, 2.0),
            velocity_mps: Vec2::new(4.0, 5.0),
            cog_rad: 6.0,
            sog_mps: 7.0,
            psi_rad: None,
            length_m: Some(8.0),
            beam_m: None,
            covariance,
            age_s: 9.0,
            since_update_s: 10.0,
        };
        same(json!(Track::from(track)), json!(track));
    }

    #[test]
    fn both_forms_of_an_order_are_read() {
        let read = |order: &str| {
            let line = format!(r#"{{"type":"order","seq":1,"order":{order}}}"#);
            serde_json::from_str::<OrderAnswer>(&line).map(api::Command::from)
        };
        let course = read(r#"{"course_speed":{"course_rad":-1,"speed_mps":2.5}}"#).unwrap();
        assert_eq!(course, api::Command::course_speed(-1.0, 2.5));
        let velocity = read(r#"{"velocity_mps":[0.1,1e-320]}"#).unwrap();
        assert_eq!(velocity, api::Command::velocity(Vec2::new(0.1, 1e-320)));
        assert!(read(r#"{"course_speed":{"course_rad":-1}}"#).is_err());
        assert!(read(r#"{"velocity_mps":[1,2,3]}"#).is_err());
        assert!(read(r#"{"velocity_mps":[true,2]}"#).is_err());
    }
}
