//! Geometry that cannot be interpolated is refused with the value, the limit and the remedy.

use super::{refused, refused_words, run_refused};

#[test]
fn a_coordinate_that_is_no_whole_number_is_named() {
    for (point, word) in [
        ("a,b", "'a'"),
        ("5,b", "'b'"),
        ("1.5,2", "'1.5'"),
        ("1e3,2", "'1e3'"),
        ("5,", "''"),
        (",5", "''"),
        (",", "''"),
        ("5,,6", "''"),
        ("5;6", "'5;6'"),
        ("0x5,6", "'0x5'"),
        ("--5,6", "'--5'"),
        ("nan,1", "'nan'"),
        ("٣,٤", "'٣'"),
    ] {
        for option in ["--to", "--from", "--center"] {
            let words = format!("ppc-arc --to 5,0 --ccw {option} {point}").replace("--to 5,0 --ccw --to", "--ccw --to");
            run_refused(&words, &[word, "whole numbers of BLU, such as 8,6", option]);
        }
    }
}

#[test]
fn an_empty_point_is_refused() {
    refused_words(&["run", "ppc-line", "--to", ""], &["invalid coordinate ''"]);
    refused_words(&["run", "ppc-line", "--to", "5, x"], &["invalid coordinate 'x'"]);
}

#[test]
fn a_number_beyond_every_limit_is_named() {
    for number in ["99999999999999999999", "-99999999999999999999", "9223372036854775808"] {
        run_refused(&format!("dda-line --to {number},1"), &[number, "too large", "±2^52"]);
    }
    for number in ["9223372036854775807", "-9223372036854775808", "4503599627370497"] {
        run_refused(
            &format!("dda-line --to 1,{number}"),
            &[&format!("y = {number} BLU"), "±4503599627370496", "larger BLU"],
        );
    }
    run_refused("ppc-arc --from 5,0 --to 0,5 --center 9007199254740992,0 --cw", &["x = 9007199254740992 BLU"]);
}

#[test]
fn a_missing_end_point_is_asked_for_in_the_models_own_terms() {
    run_refused("ppc-line", &["end point is missing", "ppc-line takes lines of 2 to 6 axes", "--to X,Y"]);
    run_refused("dda-line --from 1,2", &["end point is missing", "lines of 2 to 6 axes"]);
    run_refused("ppc-arc --from 5,0 --ccw", &["end point is missing", "ppc-arc takes arcs", "--cw|--ccw"]);
    refused("run ppc-line --to", &["a value is required for '--to <X,Y[,Z]>'"]);
}

#[test]
fn too_few_or_too_many_axes_are_counted() {
    run_refused("ppc-line --to 5", &["lines of 2 to 6 axes", "a displacement of one axis was given"]);
    run_refused("dda-line --to 1,2,3,4,5,6,7", &["lines of 2 to 6 axes", "a line of 7 axes was given"]);
    run_refused("dda-line --to 1,2,3,4,5,6,7,8,9,10", &["1 to 9 axes, not 10"]);
    run_refused("vector-line --to 1,2,3", &["vector-line interpolates lines of 2 axes", "a line of 3 axes was given"]);
}

#[test]
fn start_and_end_must_have_the_same_axes() {
    run_refused("dda-line --from 1,2 --to 1,2,3", &["start point has 2 coordinates", "end point has 3", "same axes"]);
    run_refused("dda-line --from 1,2,3 --to 1,2", &["start point has 3 coordinates", "end point has 2"]);
}

#[test]
fn a_line_of_length_0_and_a_circle_of_radius_0_are_refused() {
    run_refused("ppc-line --to 0,0", &["ends where it starts", "length 0"]);
    run_refused("dda-line --from 4,-4,1 --to 4,-4,1", &["ends where it starts", "length 0"]);
    run_refused("ppc-arc --to 5,0 --cw", &["starts at its centre (0, 0)", "radius 0"]);
    run_refused("dda-arc --from 7,8 --to 7,8 --center 7,8 --cw", &["starts at its centre (7, 8)"]);
    run_refused("dda-arc --from 1,0 --to 0,0 --ccw", &["ends at its centre (0, 0)"]);
}

#[test]
fn an_end_point_more_than_1_blu_off_the_circle_is_refused_with_both_radii() {
    for model in ["ppc-arc", "dda-arc"] {
        let words = format!("{model} --from 5,0 --to 0,7 --ccw");
        run_refused(&words, &["5.000 BLU at the start point", "7.000 BLU at the end point", "at most 1 BLU"]);
        run_refused(&format!("{model} --from 5,0 --to -3,0 --center 0,1 --ccw"), &["5.099 BLU", "3.162 BLU"]);
    }
}

#[test]
fn an_arc_needs_exactly_one_direction() {
    run_refused("ppc-arc --from 5,0 --to 0,5", &["direction of the arc is missing", "--cw or --ccw"]);
    run_refused("dda-arc --from 5,0 --to 0,5", &["direction of the arc is missing", "--cw or --ccw"]);
    run_refused("ppc-arc --from 5,0 --to 0,5 --cw --ccw", &["--cw", "--ccw"]);
}

#[test]
fn a_line_has_neither_centre_nor_direction() {
    run_refused("ppc-line --to 5,3 --center 1,1", &["ppc-line", "--center", "leave it out"]);
    run_refused("dda-line --to 5,3 --cw", &["dda-line", "--cw", "leave it out"]);
    run_refused("dda-line --to 5,3 --ccw", &["--ccw", "leave it out"]);
}

#[test]
fn a_parabola_and_a_hyperbola_have_no_direction() {
    for (noun, sizes) in
        [("parabola", "--parabola 4 --from 0,0 --to 4,4"), ("hyperbola", "--hyperbola 3,2 --from 3,0 --to 5,3")]
    {
        for turn in ["--cw", "--ccw"] {
            let hints = [noun, "no direction", "leave --cw or --ccw out"];
            run_refused(&format!("dda-conic {sizes} {turn}"), &hints);
            refused(&format!("compare dda-conic {sizes} {turn}"), &hints);
        }
    }
}

#[test]
fn an_arc_lies_in_the_plane() {
    run_refused("ppc-arc --from 5,0,0 --to 0,5 --ccw", &["--from of an arc has 3 coordinates", "give X,Y"]);
    run_refused("dda-arc --from 5,0 --to 0,5,1 --ccw", &["--to of an arc has 3 coordinates"]);
    run_refused("dda-arc --from 5,0 --to 0,5 --center 0,0,0 --ccw", &["--center of an arc has 3 coordinates"]);
    run_refused("dda-arc --from 5 --to 0,5 --ccw", &["--from of an arc has 1 coordinates"]);
}
