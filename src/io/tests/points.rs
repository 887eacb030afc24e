//! Points as text.

use super::*;

fn csv(text: impl AsRef<[u8]>) -> Result<Loaded, Error> {
    parsed(Format::Csv, text)
}

fn xyz(text: impl AsRef<[u8]>) -> Result<Loaded, Error> {
    parsed(Format::Xyz, text)
}

#[test]
fn every_common_form_of_csv_is_read() {
    let flat = [0.5, 1.0, -2.0, 3e2];
    for text in [
        "0.5,1\n-2,3e2\n",
        "0.5;1\r\n-2;3e2",
        "0.5\t1\n\n-2\t3e2\n",
        "\u{feff}x,y\n0.5,1\n-2,3e2\n",
        "# from a survey\nx, y\n0.5, 1\n -2 ,3e2\n",
        "\"X\",\"Y\"\n\"0.5\",\"1\"\n-2,3e2\n",
        "0.5,1\n# between\n-2,3e2",
    ] {
        let loaded = mesh(csv(text), Two, &flat, &[]);
        assert!(loaded.dropped.is_empty() && loaded.has_points_only(), "{text}");
    }
    let raised = [8.5, 47.0, 430.0, 8.25, 46.5, 1200.0];
    for text in [
        "8.5,47,430\n8.25,46.5,1200",
        "8.5,47,430,1,2\n8.25,46.5,1200,name,\n",
        "id,Lat,Lon,Elevation\n1,47,8.5,430\n2,46.5,8.25,1200\n",
        "name;easting;northing;height\n\"a;\nb\";8.5;47;430\nc;8.25;46.5;1200\n",
    ] {
        mesh(csv(text), Three, &raised, &[]);
    }
    assert_eq!(csv("a,x,y\n1,2,3\n").unwrap().dropped, ["further columns"]);
    assert_eq!(csv("x,y,z\n1,2,0\n").unwrap().mesh.dimension(), Two);
    assert_eq!(csv("x,y\n").unwrap().mesh.vertex_count(), 0);
}

#[test]
fn every_common_form_of_xyz_is_read() {
    let raised = [8.5, 47.0, 430.0, 8.25, 46.5, 1200.0];
    for text in [
        "8.5 47 430\n8.25 46.5 1200\n",
        "  8.5\t47   430  \r8.25 46.5 1200",
        "// X Y Z\n8.5,47,430\n8.25,46.5,1200 // last\n",
        "x y z\n8.5 47 430 255 0 0\n8.25 46.5 1200 0 0 0\n",
        "#\n8.5; 47; 430\n8.25; 46.5; 1200\n",
    ] {
        mesh(xyz(text), Three, &raised, &[]);
    }
    mesh(xyz("1 2\n3 4"), Two, &[1.0, 2.0, 3.0, 4.0], &[]);
}

#[test]
fn what_is_no_point_is_named_with_its_line() {
    refused(csv("x,y\n1,2\n3\n"), "line 3: expected at least 2 columns, found 1");
    refused(csv("1,2\n\n  \n# c\n3,\n"), "line 5: expected a number, found ``");
    refused(csv("1,2\n3,four"), "line 2: expected a number, found `four`");
    refused(csv("1,2\n3,NaN"), "line 2: `NaN` is not a finite number");
    refused(csv("1"), "line 1: expected at least 2 columns, found 1");
    let unnamed = "no columns are named x and y, lon and lat, or easting and northing; found `a`, `b`";
    refused(csv("# c\na,b\n1,2\n"), &format!("line 2: {unnamed}"));
    refused(xyz("C 0 0 0"), "line 1: expected a number, found `C`");
    refused(xyz("1 2 3\n4 5\n"), "line 2: expected at least 3 columns, found 2");
    refused(xyz(""), "line 1: the file is empty");
}

#[test]
fn text_decides_the_floats_of_points() {
    let bits = |loaded: Loaded| matches!(loaded.mesh.positions(), Positions::F64(_));
    assert!(!bits(csv("0.1,0.2").unwrap()));
    assert!(bits(csv("8.123456789,0.2\n1,2").unwrap()));
    assert!(bits(xyz("1 2\n2600000.125 1200000.5").unwrap()));
    let options = ReadOptions { coordinates: Some(Coordinates::F32), ..ReadOptions::default() };
    let narrow = parse(Format::Csv, b"8.123456789,0.2".as_slice(), &options).unwrap();
    assert_eq!(narrow.notes, ["the coordinates were rounded to 32-bit floats"]);
}

#[test]
fn points_are_triangulated_and_keep_their_heights() {
    let mut loaded = xyz("0 0 5\n4 0 6\n4 3 7\n0 3 8\n4 0 9\n").unwrap();
    let made = loaded.triangulate(Plane::Xy).unwrap();
    assert_eq!(made.triangles, [0, 1, 2, 0, 2, 3]);
    assert_eq!(made.duplicates, [[4, 1]]);
    assert_eq!(loaded.mesh.triangles(), made.triangles);
    assert_eq!(loaded.mesh.positions().at(14), 9.0);
    assert!(!loaded.has_points_only());
    let written = loaded.file_bytes("a.off", made.triangles).unwrap();
    assert_eq!(written, b"OFF\n5 2 0\n0 0 5\n4 0 6\n4 3 7\n0 3 8\n4 0 9\n3 0 1 2\n3 0 2 3\n");
}

#[test]
fn points_are_only_read() {
    let known = "use one of: .off, .obj, .ply, .stl, .gltf, .glb, also gzip'd (.gz)";
    for name in ["a.csv", "a.xyz.gz"] {
        let error = off("OFF 0 0").unwrap().file_bytes(name, Vec::new()).unwrap_err();
        assert_eq!(error.to_string(), format!("{name}: unknown format; {known}"));
    }
    let square = Mesh::new(Two, vec![0.0, 0.0, 1.0, 0.0, 0.0, 1.0], vec![0, 1, 2]).unwrap();
    assert!(to_bytes(Format::Csv, &square).is_err());
}
