//! The labels of DNV's 55 baseline situations (140 encounters), at their half-angle of 5 degrees.
//!
//! Bearings were computed from the positions, courses and speeds of the ship-traffic-generator of
//! DNV (data/baseline_situations_generated at 2e93ffe5, MIT, (c) 2025 DNV) on a flat earth around
//! own ship, rounded to a tenth of a degree.

use super::*;
use geom::EncounterClass;

/// Situation and target, DNV's label, relative bearing and contact angle at the start (degrees).
const ENCOUNTERS: &str = "\
1a HO 2.0 -1.6; 2a CR-GW 20.0 -25.4; 3a CR-SO -30.0 56.1; 4a OT-GW 15.0 -149.2
5a OT-SO -165.0 9.9; 6a HO -1.0 1.1; 6b HO 4.0 -3.6; 7a HO -4.0 2.9; 7b CR-GW 35.9 -47.6
8a HO 4.0 -2.7; 8b CR-SO -36.0 47.6; 9a HO -2.0 1.8; 9b OT-GW 10.0 -159.9; 10a HO 0.0 -0.0
10b OT-SO 176.0 -2.4; 11a CR-GW 18.0 -13.7; 11b CR-GW 102.0 -44.3; 12a CR-GW 44.9 -36.0
12b CR-SO -99.0 49.3; 13a CR-GW 60.0 -35.4; 13b OT-GW 34.9 -125.0; 14a CR-GW 80.0 -54.8
14b OT-SO -150.1 17.2; 15a CR-SO -85.0 41.7; 15b CR-SO -100.0 38.2; 16a CR-SO -105.0 47.8
16b OT-SO -165.0 9.3; 17a CR-SO -105.0 53.3; 17b OT-GW 30.0 -141.1; 18a OT-GW 15.0 -158.3
18b OT-GW 25.0 -135.5; 19a OT-GW 20.0 -145.5; 19b OT-SO 175.0 -3.3; 20a OT-SO 160.0 -13.2
20b OT-SO 170.0 -6.7; 21a HO -2.0 1.6; 21b HO 0.0 -0.0; 21c HO 4.0 -2.7; 22a HO -3.0 2.1
22b HO 2.0 -2.0; 22c CR-GW 38.0 -50.6; 23a HO 5.0 -3.3; 23b HO 2.0 -1.4; 23c CR-SO -37.0 59.3
24a HO -3.0 2.5; 24b HO 2.0 -1.4; 24c OT-GW 8.0 -164.0; 25a HO -4.0 2.4; 25b HO 0.0 -0.0
25c OT-SO 162.0 -9.3; 26a HO 3.0 -2.0; 26b CR-GW 20.0 -14.2; 26c CR-GW 102.0 -54.3
27a HO -2.0 1.4; 27b CR-GW 44.9 -36.0; 27c CR-SO -99.0 44.9; 28a HO -3.0 2.5
28b CR-GW 54.9 -35.9; 28c OT-GW 30.0 -124.0; 29a HO -1.0 1.1; 29b CR-GW 80.0 -54.8
29c OT-SO -150.1 19.5; 30a HO 1.0 -1.3; 30b CR-SO -85.0 41.7; 30c CR-SO -100.0 38.2
31a HO 0.0 -0.0; 31b CR-SO -100.0 54.8; 31c OT-SO -155.0 14.4; 32a HO -1.0 2.0
32b CR-SO -110.0 46.1; 32c OT-GW 35.0 -134.0; 33a HO 3.0 -2.7; 33b OT-GW 20.0 -137.4
33c OT-GW 25.0 -142.9; 34a HO -3.0 2.3; 34b OT-GW 20.0 -145.5; 34c OT-SO 175.0 -3.1
35a HO 2.0 -1.5; 35b OT-SO 155.0 -14.4; 35c OT-SO 170.0 -6.6; 36a CR-GW 15.0 -10.0
36b CR-GW 35.0 -24.3; 36c CR-GW 102.0 -54.3; 37a CR-GW 85.0 -38.7; 37b CR-GW 44.9 -36.0
37c CR-SO -105.0 43.6; 38a CR-GW 9.0 -7.5; 38b CR-GW 44.9 -30.4; 38c OT-GW 20.0 -123.1
39a CR-GW 10.0 -5.9; 39b CR-GW 80.0 -54.8; 39c OT-SO -170.0 6.7; 40a CR-GW 10.0 -16.7
40b CR-SO -75.0 40.2; 40c CR-SO -100.0 35.6; 41a CR-GW 75.0 -32.3; 41b CR-SO -35.0 24.3
41c OT-SO -155.0 14.4; 42a CR-GW 44.9 -52.3; 42b CR-SO -49.9 28.8; 42c OT-GW 34.9 -125.0
43a CR-GW 25.0 -20.6; 43b OT-GW 15.0 -149.2; 43c OT-GW -25.0 142.9; 44a CR-GW 65.0 -40.4
44b OT-GW 20.0 -137.4; 44c OT-SO 175.0 -3.1; 45a CR-GW 25.0 -20.6; 45b OT-SO 155.0 -14.4
45c OT-SO -170.0 6.7; 46a CR-SO -10.0 16.7; 46b CR-SO -75.0 40.2; 46c CR-SO -30.0 19.6
47a CR-SO -20.0 11.7; 47b CR-SO -49.9 33.2; 47c OT-SO -165.0 8.8; 48a CR-SO -44.9 52.3
48b CR-SO -60.0 35.4; 48c OT-GW 34.9 -125.0; 49a CR-SO -25.0 17.6; 49b OT-GW 15.0 -154.6
49c OT-GW -25.0 142.9; 50a CR-SO -65.0 40.4; 50b OT-GW 15.0 -140.7; 50c OT-SO 175.0 -3.3
51a CR-SO -25.0 19.0; 51b OT-SO 155.0 -13.5; 51c OT-SO -160.0 13.2; 52a OT-GW -15.0 158.3
52b OT-GW 15.0 -154.6; 52c OT-GW -25.0 123.3; 53a OT-GW 0.0 -180.0; 53b OT-GW 10.0 -154.8
53c OT-SO -175.0 2.9; 54a OT-GW -30.0 134.5; 54b OT-SO 155.0 -13.5; 54c OT-SO -160.0 11.7
55a OT-SO 170.0 -6.6; 55b OT-SO 155.0 -16.4; 55c OT-SO -160.0 13.2";

#[test]
fn every_encounter_gets_the_label_of_its_source() {
    let head_on = with("head_on_half_angle_deg", 5.0).head_on();
    let mut counts = [0; EncounterClass::ALL.len()];
    let joined = ENCOUNTERS.replace('\n', "; ");
    for encounter in joined.split("; ") {
        let fields: Vec<&str> = encounter.split(' ').collect();
        let label = match fields[1] {
            "HO" => EncounterClass::HeadOn,
            "CR-GW" => EncounterClass::CrossingStbd,
            "CR-SO" => EncounterClass::CrossingPort,
            "OT-GW" => EncounterClass::Overtaking,
            "OT-SO" => EncounterClass::Overtaken,
            other => panic!("{other} is no label"),
        };
        let angle = |field: &str| deg(field.parse().unwrap());
        let found = geom::classify(angle(fields[2]), angle(fields[3]), head_on);
        assert_eq!(found, label, "{encounter}");
        counts[label as usize] += 1;
    }
    // 28 of each
    assert_eq!(counts, [28, 28, 28, 28, 28, 0]);
}
