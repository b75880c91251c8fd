//! Reads sensors: the objects that they measure, resolved to ids, and the parameters of their values.
//!
//! The kinds of sensors, and the objects that each kind can be attached to, are defined in the table of [`crate::sensor`].

use crate::kinds::{interpolation, joint};
use crate::mjcf::classes::Props;
use crate::mjcf::gather::listed;
use crate::mjcf::ids::References;
use crate::mjcf::rules::{self, Rule};
use crate::mjcf::settings::checked;
use crate::mjcf::spec::{NumberList, SensorObjects, SensorSpec, SensorTiming, TendonSpec};
use crate::mjcf::text::diagnostic::{Diagnostics, shorten_name};
use crate::mjcf::text::tree::{ElementNode, ElementTree, name};
use crate::model::Obj;
use crate::sensor::{
    CONTACT_DATA, Datatype, KINDS, RAY_DATA, SensorKind, SensorStage, SensorTarget, data_size,
};

/// Limit for the number of values of all sensors, including samples that are stored for delays.
const MAX_VALUES: usize = 1 << 22;

/// The inputs for reading a sensor.
struct SensorContext<'a> {
    node: &'a ElementNode,
    /// The attributes of the sensor. Sensors have no defaults.
    p: Props,
    refs: References<'a>,
    tendons: &'a [TendonSpec],
    report: &'a mut Diagnostics,
}

/// All sensors in the order of the text.
pub(crate) fn sensors(
    tree: &ElementTree,
    refs: References,
    tendons: &[TendonSpec],
    report: &mut Diagnostics,
) -> Vec<SensorSpec> {
    let mut list = Vec::new();
    let mut values = 0;
    for (section, _) in tree.sections("sensor") {
        for (_, node) in tree.children(section) {
            if report.is_full() {
                return list;
            }
            let Some(number) = KINDS.iter().position(|k| k.name == node.element.name) else { continue };
            let mut cx = SensorContext { node, p: Props::written_props(node), refs, tendons, report };
            let Some(sensor) = cx.sensor(number, &KINDS[number]) else { continue };
            let samples = 1 + sensor.timing.nsample.max(0) as usize;
            values += samples.saturating_mul(1 + sensor.dim as usize);
            if values > MAX_VALUES {
                report
                    .error(
                        rules::LIMIT,
                        node.span.clone(),
                        format!("the sensors have more than {MAX_VALUES} values"),
                    )
                    .why("every step would compute and store them all")
                    .help("lower `num`, `nsample`, `dim` or the camera's `resolution`");
                return list;
            }
            list.push(sensor);
        }
    }
    list
}

impl SensorContext<'_> {
    fn sensor(&mut self, number: usize, kind: &'static SensorKind) -> Option<SensorSpec> {
        let cutoff = self.not_negative("cutoff");
        let noise = self.not_negative("noise");
        let timing = self.timing();
        let objects = self.objects(kind)?;
        let (intprm, dim) = self.parameters(kind, &objects)?;
        let (datatype, when) = self.meaning(kind, dim);
        // The values of a sensor of a pair are clamped by the distance, so that a cutoff of a normal is valid.
        let unit = matches!(datatype, Datatype::Axis | Datatype::Quaternion);
        if cutoff > 0.0 && unit && kind.senses != SensorTarget::Pair {
            let what = if datatype == Datatype::Axis { "an axis" } else { "a quaternion" };
            self.error_at("cutoff", rules::SENSOR, format!("{} has a cutoff", self.node.describe()))
                .why(format!("clamping the numbers of {what} would not leave a rotation"))
                .help("remove `cutoff`");
        }
        Some(SensorSpec {
            name: name(self.node),
            kind: number as i32,
            objects,
            intprm,
            dim,
            datatype: datatype as i32,
            needstage: when,
            cutoff,
            noise,
            timing,
            user: NumberList::read(&self.p, "user"),
        })
    }

    /// Reports an error at an attribute, or at the element if the attribute is absent.
    fn error_at(
        &mut self,
        attribute: &str,
        code: &'static Rule,
        message: String,
    ) -> crate::mjcf::text::diagnostic::ReportedFinding<'_> {
        let span = self.node.attribute(attribute).map_or(self.node.span.clone(), |a| a.span.clone());
        self.report.error(code, span, message)
    }

    fn not_negative(&mut self, attribute: &str) -> f64 {
        let owner = self.node.describe();
        checked(&self.p, attribute, &owner, |x| x >= 0.0, "zero or more", self.report).unwrap_or(0.0)
    }

    /// The delay, the period and the number of stored samples.
    fn timing(&mut self) -> SensorTiming {
        let owner = self.node.describe();
        let [period, phase] = self.p.reals("interval", [0.0; 2]);
        let timing = SensorTiming {
            nsample: self.p.int("nsample").unwrap_or(0),
            interp: self.p.keyword("interp").unwrap_or(interpolation::HOLD),
            delay: self.p.real("delay").unwrap_or(0.0),
            interval: [period, phase],
        };
        if timing.nsample < 0 {
            let span = self.p.span("nsample").unwrap_or(self.node.span.clone());
            self.report
                .warning(
                    rules::NO_EFFECT,
                    span,
                    format!("`nsample` of {owner} is negative, so it keeps no values"),
                )
                .help("write 0, or remove it: it is the number of stored values");
        }
        if timing.delay > 0.0 && timing.nsample <= 0 {
            self.error_at("delay", rules::CONFLICT, format!("{owner} has a delay but keeps no values"))
                .why("a delayed value is read from past values")
                .help("write `nsample`: at least the delay divided by the timestep, rounded up");
        }
        let in_range = period > 0.0 && phase > -period || period == 0.0;
        if !in_range || phase > 0.0 {
            self.error_at("interval", rules::VALUE, format!("`interval` of {owner} is out of range"))
                .why("it is a period, s, and the time of the first reading before the start")
                .help(
                    "write a period of zero or more, and a second number between minus the period and zero",
                );
        }
        timing
    }

    /// Reports that an attribute is missing.
    fn missing<T>(&mut self, attributes: &[&str]) -> Option<T> {
        let list: Vec<String> = listed(attributes.iter().map(|a| format!("`{a}`")));
        let message = format!("{} has no {}", self.node.describe(), list.join(" or "));
        self.error_at("", rules::MISSING_ATTRIBUTE, message).why("it is the object that the sensor reads");
        None
    }

    /// The id of the object that an attribute names. The check of references reports unknown names.
    fn id(&self, attribute: &str, kind: &str) -> Option<i32> {
        self.refs.optional(kind, self.node, attribute)
    }

    /// The only attribute of a list that is present: its index in the list, and the id of the object that it names. Two present
    /// attributes are an error.
    fn one_of(&mut self, attributes: &[(&'static str, &'static str)]) -> Option<Option<(usize, i32)>> {
        let mut given = attributes.iter().enumerate().filter(|(_, (a, _))| self.node.attribute(a).is_some());
        let Some((position, &(attribute, kind))) = given.next() else { return Some(None) };
        if let Some((_, &(other, _))) = given.next() {
            let message = format!("{} has both `{attribute}` and `{other}`", self.node.describe());
            self.error_at(other, rules::CONFLICT, message)
                .why("they are two ways to name the same side")
                .help("keep one of them");
            return None;
        }
        if self.node.text(attribute).is_none() {
            return self.missing(&[attribute]);
        }
        Some(Some((position, self.id(attribute, kind)?)))
    }

    /// The site and the camera in whose image it is.
    fn site_in_image(&mut self) -> Option<SensorObjects> {
        let (site, camera) = (self.required("site", "site"), self.required("camera", "camera"));
        if camera.is_some_and(|camera| self.refs.ids.has_no_pixels(camera)) {
            let message = format!("the camera of {} has no resolution", self.node.describe());
            self.error_at("camera", rules::SENSOR, message)
                .why("the place in the image is counted in pixels")
                .help("give the camera a `resolution` without zeros");
        }
        Some(SensorObjects::for_object(Obj::Site as i32, site?).with_reference(Obj::Camera as i32, camera?))
    }

    /// The objects that the sensor is attached to.
    fn objects(&mut self, kind: &SensorKind) -> Option<SensorObjects> {
        let attached = |obj: Obj, id: i32| SensorObjects::for_object(obj as i32, id);
        match kind.senses {
            SensorTarget::Nothing | SensorTarget::Tactile | SensorTarget::Plugin => {
                Some(SensorObjects::default())
            }
            SensorTarget::Site => self.required("site", "site").map(|id| attached(Obj::Site, id)),
            SensorTarget::Tendon | SensorTarget::LimitedTendon => {
                let id = self.required("tendon", "tendon")?;
                if kind.senses == SensorTarget::LimitedTendon
                    && !self.tendons.get(id as usize).is_some_and(|t| t.limited)
                {
                    self.has_no_limits("tendon");
                }
                Some(attached(Obj::Tendon, id))
            }
            SensorTarget::Actuator => {
                self.required("actuator", "actuator").map(|id| attached(Obj::Actuator, id))
            }
            SensorTarget::Subtree => self.required("body", "body").map(|id| attached(Obj::Body, id)),
            SensorTarget::ScalarJoint | SensorTarget::BallJoint | SensorTarget::LimitedJoint => {
                let id = self.required("joint", "joint")?;
                self.check_joint(kind, id);
                Some(attached(Obj::Joint, id))
            }
            SensorTarget::Ray => match self.one_of(&[("site", "site"), ("camera", "camera")])? {
                Some((0, id)) => Some(attached(Obj::Site, id)),
                Some((_, id)) => Some(attached(Obj::Camera, id)),
                None => self.missing(&["site", "camera"]),
            },
            SensorTarget::SiteInImage => self.site_in_image(),
            SensorTarget::Frame => self.frame("objtype", "objname"),
            SensorTarget::RelativeFrame => {
                let object = self.frame("objtype", "objname")?;
                if self.node.attribute("reftype").is_none() && self.node.attribute("refname").is_none() {
                    return Some(object);
                }
                let reference = self.frame("reftype", "refname")?;
                Some(object.with_reference(reference.objtype, reference.objid))
            }
            SensorTarget::FrameInSite => {
                let (object, site) = (self.frame("objtype", "objname"), self.required("site", "site"));
                Some(object?.with_reference(Obj::Site as i32, site?))
            }
            SensorTarget::Pair => self.pair(),
            SensorTarget::Contacts => self.contact_filter(),
            SensorTarget::User => {
                if self.node.attribute("objtype").is_none() && self.node.attribute("objname").is_none() {
                    return Some(SensorObjects::default());
                }
                self.frame("objtype", "objname")
            }
        }
    }

    /// The id of an object that is required.
    fn required(&mut self, attribute: &str, kind: &str) -> Option<i32> {
        if self.node.text(attribute).is_none() {
            return self.missing(&[attribute]);
        }
        self.id(attribute, kind)
    }

    /// An object that is given by its kind and its name.
    fn frame(&mut self, objtype: &str, objname: &str) -> Option<SensorObjects> {
        for attribute in [objtype, objname] {
            if self.node.attribute(attribute).is_none() {
                return self.missing(&[attribute]);
            }
        }
        let objtype = self.p.keyword(objtype)?;
        let kind = crate::mjcf::ids::keyword(objtype);
        match self.id(objname, kind) {
            Some(id) => Some(SensorObjects::for_object(objtype, id)),
            None => {
                let attribute = self.node.attribute(objname)?;
                let name = self.node.text(objname).unwrap_or("");
                if self.refs.names.find(kind, name).is_none() {
                    self.refs.names.unknown(kind, name, attribute.span.clone(), self.report);
                }
                None
            }
        }
    }

    /// Two sides, each a geom, or a body that represents all its geoms.
    fn pair(&mut self) -> Option<SensorObjects> {
        let side =
            |(position, id): (usize, i32)| (if position == 0 { Obj::Geom } else { Obj::Body } as i32, id);
        let first = self.one_of(&[("geom1", "geom"), ("body1", "body")])?.map(side);
        let second = self.one_of(&[("geom2", "geom"), ("body2", "body")])?.map(side);
        let (Some(first), Some(second)) = (first, second) else {
            let missing = if first.is_none() { ["geom1", "body1"] } else { ["geom2", "body2"] };
            return self.missing(&missing);
        };
        if first == second {
            let message = format!("both sides of {} are the same", self.node.describe());
            self.error_at("geom2", rules::SENSOR, message).help("name two different geoms or bodies");
            return None;
        }
        Some(SensorObjects::for_object(first.0, first.1).with_reference(second.0, second.1))
    }

    /// The optional objects that a contact must involve: geoms, bodies, subtrees or a site.
    fn contact_filter(&mut self) -> Option<SensorObjects> {
        const KINDS: [Obj; 4] = [Obj::Geom, Obj::Body, Obj::XBody, Obj::Site];
        let side = |found: Option<(usize, i32)>| {
            found.map_or((0, -1), |(position, id)| (KINDS.get(position).map_or(0, |&k| k as i32), id))
        };
        let first = [("geom1", "geom"), ("body1", "body"), ("subtree1", "body"), ("site", "site")];
        let second = [("geom2", "geom"), ("body2", "body"), ("subtree2", "body")];
        let (first, second) = (side(self.one_of(&first)?), side(self.one_of(&second)?));
        Some(SensorObjects::for_object(first.0, first.1).with_reference(second.0, second.1))
    }

    fn check_joint(&mut self, kind: &SensorKind, id: i32) {
        let Some((is, limited)) = self.refs.ids.joint(id) else { return };
        let (fits, needs) = match kind.senses {
            SensorTarget::BallJoint => (is == joint::BALL, "a ball joint"),
            SensorTarget::LimitedJoint if !limited => return self.has_no_limits("joint"),
            SensorTarget::LimitedJoint => return,
            _ => (matches!(is, joint::SLIDE | joint::HINGE), "a slide or hinge joint"),
        };
        if fits {
            return;
        }
        let is = ["free", "ball", "slide", "hinge"].get(is as usize).copied().unwrap_or("");
        let joint = shorten_name(self.node.text("joint").unwrap_or(""));
        self.error_at("joint", rules::SENSOR, format!("`{}` reads joint {joint}, a {is} joint", kind.name))
            .help(format!("use {needs}; `framepos` and `framequat` read the pose of any body"));
    }

    fn has_no_limits(&mut self, what: &'static str) {
        let message = format!(
            "`{}` reads {what} {}, which has no limits",
            self.node.element.name,
            shorten_name(self.node.text(what).unwrap_or(""))
        );
        self.error_at(what, rules::SENSOR, message)
            .why("the sensor would always read zero")
            .help(format!("give the {what} a `range`, or remove the sensor"));
    }

    /// The integer parameters, and the number of values.
    fn parameters(&mut self, kind: &SensorKind, objects: &SensorObjects) -> Option<([i32; 3], i32)> {
        match kind.senses {
            SensorTarget::Ray => {
                let mask = self.data_fields(&RAY_DATA)?;
                if objects.objtype == Obj::Camera as i32 && self.refs.ids.is_negative(objects.objid) {
                    let message = format!("the camera of {} has a negative resolution", self.node.describe());
                    self.error_at("camera", rules::SENSOR, message)
                        .help("write its width and height in pixels");
                    return None;
                }
                let pixels = self.refs.ids.pixels(objects);
                Some(([mask, 0, 0], self.dim(pixels, data_size(&RAY_DATA, mask))?))
            }
            SensorTarget::Contacts => {
                let mask = self.data_fields(&CONTACT_DATA)?;
                let num = self.p.int("num").unwrap_or(1);
                if num <= 0 {
                    self.error_at("num", rules::VALUE, format!("`num` of {} is {num}", self.node.describe()))
                        .help("write the number of contacts to report, one or more");
                    return None;
                }
                let dim = self.dim(num as usize, data_size(&CONTACT_DATA, mask))?;
                Some(([mask, self.p.keyword("reduce").unwrap_or(0), num], dim))
            }
            SensorTarget::User => {
                if !self.p.has("dim") {
                    return self.missing(&["dim"]);
                }
                let dim = self.p.int("dim")?;
                if dim < 0 {
                    self.error_at(
                        "dim",
                        rules::VALUE,
                        format!("`dim` of {} is negative", self.node.describe()),
                    );
                    return None;
                }
                Some(([0; 3], dim))
            }
            SensorTarget::Actuator => Some(([0; 3], self.refs.ids.outputs(objects.objid))),
            _ => Some(([0; 3], kind.dim)),
        }
    }

    /// The product of two counts as the number of values, if it is within the limit.
    fn dim(&mut self, n: usize, size: usize) -> Option<i32> {
        let dim = n.saturating_mul(size);
        if dim > MAX_VALUES {
            let message = format!("{} has more than {MAX_VALUES} values", self.node.describe());
            self.error_at("", rules::LIMIT, message).help("lower `num` or the camera's `resolution`");
            return None;
        }
        Some(dim as i32)
    }

    /// The mask of the fields that the attribute `data` lists. Without the attribute, the first field.
    fn data_fields(&mut self, fields: &[(&'static str, usize)]) -> Option<i32> {
        let (mut mask, mut last) = (0, None);
        let text = self.node.text("data").unwrap_or("").to_string();
        let all: Vec<&str> = listed(fields.iter().map(|(name, _)| *name));
        let all = all.join(" ");
        for word in text.split_ascii_whitespace() {
            let Some(index) = fields.iter().position(|(name, _)| *name == word) else {
                let message = format!("`data` of {} lists {}", self.node.describe(), shorten_name(word));
                self.error_at("data", rules::KEYWORD, message).help(format!("use only these: {all}"));
                return None;
            };
            if last.is_some_and(|last| index <= last) {
                let message = format!("`data` of {} lists its fields out of order", self.node.describe());
                self.error_at("data", rules::KEYWORD, message)
                    .why("values always have the same order, and each field appears once")
                    .help(format!("use the order {all}"));
                return None;
            }
            last = Some(index);
            mask |= 1 << index;
        }
        Some(if mask == 0 { 1 } else { mask })
    }

    /// The type of the values and the stage that computes them. A user sensor has attributes for these; other kinds have them in
    /// the table.
    fn meaning(&mut self, kind: &SensorKind, dim: i32) -> (Datatype, i32) {
        if kind.senses != SensorTarget::User {
            return (kind.datatype, kind.when as i32);
        }
        let datatype = match self.p.keyword("datatype") {
            Some(t) if t == Datatype::Positive as i32 => Datatype::Positive,
            Some(t) if t == Datatype::Axis as i32 => Datatype::Axis,
            Some(t) if t == Datatype::Quaternion as i32 => Datatype::Quaternion,
            _ => Datatype::Real,
        };
        let needed = match datatype {
            Datatype::Axis => 3,
            Datatype::Quaternion => 4,
            _ => dim,
        };
        if dim != needed {
            let message =
                format!("`dim` of {} is {dim}, but its `datatype` has {needed}", self.node.describe());
            self.error_at("dim", rules::CONFLICT, message).help(format!("write `dim=\"{needed}\"`"));
        }
        (datatype, self.p.keyword("needstage").unwrap_or(SensorStage::Acceleration as i32))
    }
}
