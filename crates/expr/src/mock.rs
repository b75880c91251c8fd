//! A small host for the tests, with a model, data, named objects and functions like those of a real host.

use crate::*;

const MODEL: ObjectId = ObjectId(0);
const DATA: ObjectId = ObjectId(1);
const OPT: ObjectId = ObjectId(2);
const MJ: ObjectId = ObjectId(3);
const RUN: ObjectId = ObjectId(4);
/// Joints of `data` are objects 10 and 11; bodies of `model` are objects 20 to 22.
const DATA_JOINTS: CollectionId = CollectionId(0);
const MODEL_BODIES: CollectionId = CollectionId(1);
const SENSORS: CollectionId = CollectionId(2);
const JOINTS: [&str; 2] = ["light_free", "heavy_free"];
const BODIES: [&str; 3] = ["world", "heavy", "light"];

/// A field: path, shape, kind, elements, owner.
type Row = (&'static str, &'static [Option<usize>], &'static str, Elem, &'static str);

/// Fields in the order of their keys.
const FIELDS: &[Row] = &[
    ("data.time", &[], "state", Elem::Double, ""),
    ("data.qpos", &[Some(14)], "state", Elem::Double, "the model has 14 coordinates"),
    ("data.qvel", &[Some(12)], "state", Elem::Double, "the model has 12 degrees of freedom"),
    ("data.xpos", &[Some(3), Some(3)], "derived", Elem::Double, "the model has 3 bodies"),
    ("data.ncon", &[], "derived", Elem::Double, ""),
    ("data.ctrl", &[Some(0)], "input", Elem::Double, "the model has no actuators"),
    ("data.efc_force", &[None], "derived", Elem::Double, ""),
    ("model.body_mass", &[Some(3)], "inertial", Elem::Double, "the model has 3 bodies"),
    ("model.nq", &[], "structure", Elem::Double, ""),
    ("model.geom_solref", &[Some(2), Some(2)], "constant", Elem::Double, "the model has 2 geoms"),
    ("model.opt.gravity", &[Some(3)], "constant", Elem::Double, ""),
    ("model.opt.timestep", &[], "constant", Elem::Double, ""),
    ("run.touch", &[], "structure", Elem::Double, ""),
    ("data.eq_active", &[Some(4)], "input", Elem::Byte, "the model has 4 equality constraints"),
    ("model.geom_contype", &[Some(4)], "constant", Elem::Int, "the model has 4 geoms"),
    ("model.opt.iterations", &[], "constant", Elem::Int, ""),
];

/// The terms of the host: those of a workbook. Names in examples are names of this host.
static WORDS: HostTerms = HostTerms {
    lab: "sheet",
    lesson: "workbook",
    world: "machine",
    model: "plan",
    number: "data.time",
    array: "data.qpos",
    matrix: "data.xpos",
    choice: "data.joint(\"name\")",
    parts: "{kinetic, potential} = lib.energy()",
    names: "`model`, `data`, `ctx`",
    statements: "`begin`, `tick` or `press`",
    keeper: "`tick`",
    display: "a cell or a curve",
    clock: "the time of the machine is `data.time`",
    wait: "test `data.time` in the tick instead",
    split: "split it: into several keys, or a `begin` and a `tick`",
    input: (
        "`value` is what a key gives to its own text",
        "give the key a `keeps` and read it as `ctx.<keeps>`",
    ),
    store: "store it first, as `ctx.{name} = 0` in `begin`, or give a key `\"keeps\": \"{name}\"`",
    own_number: "store it as `ctx.{name} = …` in a text of statements, and read `ctx.{name}` here",
    rounding: ", or set `places` of the cell",
    recompute: "`mj_setConst`",
};

/// A rule of the host.
const NO_ANGLE: &rules::Rule = &rules::Rule { code: "quaternion-as-angle", ..*rules::DEGREES };

const QUATERNION: AngleAdvice = AngleAdvice {
    rule: NO_ANGLE,
    what: "a component of a quaternion",
    why: "four numbers that give the orientation together",
    help: "the whole angle of the turn is `2 * Math.acos(w)`, with w the first of the four numbers",
};

/// The schema.
pub(crate) struct Mock;

fn field(path: &str) -> Option<Entry> {
    let key = FIELDS.iter().position(|f| f.0 == path)?;
    Some(Entry::Field(view(key, path.into(), 0, FIELDS[key].1.to_vec(), FIELDS[key].4.into())))
}

fn view(key: usize, path: String, first: usize, shape: Vec<Option<usize>>, owner: String) -> Field {
    let kind = match FIELDS[key].2 {
        "state" => FieldKind::State,
        "input" => FieldKind::Input,
        "inertial" => FieldKind::Inertial,
        "constant" => FieldKind::Constant,
        "structure" => FieldKind::Structure,
        _ => FieldKind::Derived { by: "the kinematics stage".into() },
    };
    let doc = if FIELDS[key].0 == "model.nq" { "the number of coordinates" } else { "" };
    Field {
        key: FieldKey(key as u32),
        path,
        first,
        shape,
        kind,
        elem: FIELDS[key].3,
        unit: String::new(),
        doc: doc.into(),
        owner,
    }
}

fn members(object: ObjectId) -> Vec<String> {
    let prefix = match object {
        MODEL => "model.",
        DATA => "data.",
        OPT => "model.opt.",
        RUN => "run.",
        _ => "none.",
    };
    let fields = FIELDS.iter().filter_map(|f| f.0.strip_prefix(prefix)).filter(|n| !n.contains('.'));
    let mut names: Vec<String> = fields.map(str::to_owned).collect();
    let more: &[&str] = match object {
        MODEL => &["opt", "body"],
        DATA => &["joint", "sensor"],
        MJ => &["mj_setConst", "mj_resetDataKeyframe"],
        ObjectId(10..=11) => &["qpos", "qvel"],
        ObjectId(20..=22) => &["mass", "id"],
        _ => &[],
    };
    names.extend(more.iter().map(|n| (*n).to_owned()));
    names
}

impl Schema for Mock {
    fn root(&self, name: &str) -> Option<Entry> {
        Some(match name {
            "model" => Entry::Object(MODEL),
            "data" => Entry::Object(DATA),
            "mj" => Entry::Object(MJ),
            "run" => Entry::Object(RUN),
            "mj_setConst" => Entry::Function(FunctionId(0)),
            "fail" => Entry::Function(FunctionId(2)),
            "say" => Entry::Function(FunctionId(3)),
            "final" => Entry::Function(FunctionId(4)),
            "bodyId" => Entry::Function(FunctionId(5)),
            "energy" => Entry::Function(FunctionId(6)),
            "norm" => Entry::Function(FunctionId(7)),
            "bodyPos" => Entry::Function(FunctionId(8)),
            _ => return None,
        })
    }

    fn root_names(&self) -> Vec<String> {
        [
            "model",
            "data",
            "mj",
            "run",
            "mj_setConst",
            "fail",
            "say",
            "final",
            "bodyId",
            "energy",
            "norm",
            "bodyPos",
        ]
        .map(String::from)
        .into()
    }

    fn member(&self, object: ObjectId, name: &str) -> Option<Entry> {
        if !members(object).iter().any(|n| n == name) {
            return None;
        }
        match (object, name) {
            (MODEL, "opt") => Some(Entry::Object(OPT)),
            (MODEL, "body") => Some(Entry::Collection(MODEL_BODIES)),
            (DATA, "joint") => Some(Entry::Collection(DATA_JOINTS)),
            (DATA, "sensor") => Some(Entry::Collection(SENSORS)),
            (MODEL, _) => field(&format!("model.{name}")),
            (DATA, _) => field(&format!("data.{name}")),
            (OPT, _) => field(&format!("model.opt.{name}")),
            (RUN, _) => field(&format!("run.{name}")),
            (MJ, "mj_setConst") => Some(Entry::Function(FunctionId(0))),
            (MJ, _) => Some(Entry::Function(FunctionId(1))),
            (ObjectId(id @ 10..=11), _) => {
                let i = (id - 10) as usize;
                let (key, n) = if name == "qpos" { (1, 7) } else { (2, 6) };
                let path = format!("data.joint(\"{}\").{name}", JOINTS[i]);
                let what = if n == 7 { "7 coordinates" } else { "6 degrees of freedom" };
                let owner = format!("the free joint \"{}\" has {what}", JOINTS[i]);
                Some(Entry::Field(view(key, path, i * n, vec![Some(n)], owner)))
            }
            (ObjectId(id), "id") => Some(Entry::Constant(Value::Number(f64::from(id - 20)))),
            (ObjectId(id), _) => {
                let i = (id - 20) as usize;
                let path = format!("model.body(\"{}\").mass", BODIES[i]);
                Some(Entry::Field(view(7, path, i, vec![], String::new())))
            }
        }
    }

    fn member_names(&self, object: ObjectId) -> Vec<String> {
        members(object)
    }

    fn describe(&self, object: ObjectId) -> String {
        match object {
            MODEL => "model".into(),
            DATA => "data".into(),
            OPT => "model.opt".into(),
            MJ => "mj".into(),
            RUN => "run".into(),
            ObjectId(id @ 10..=11) => format!("the joint \"{}\"", JOINTS[(id - 10) as usize]),
            ObjectId(id) => format!("the body \"{}\"", BODIES[(id - 20) as usize]),
        }
    }

    fn lookup(&self, collection: CollectionId, name: &str) -> Option<ObjectId> {
        let first = if collection == DATA_JOINTS { 10 } else { 20 };
        let i = self.names(collection).iter().position(|n| n == name)?;
        Some(ObjectId(first + i as u32))
    }

    fn names(&self, collection: CollectionId) -> Vec<String> {
        match collection {
            DATA_JOINTS => JOINTS.map(String::from).into(),
            MODEL_BODIES => BODIES.map(String::from).into(),
            _ => Vec::new(),
        }
    }

    fn noun(&self, collection: CollectionId) -> &str {
        match collection {
            DATA_JOINTS => "joint",
            MODEL_BODIES => "body",
            _ => "sensor",
        }
    }

    fn function(&self, function: FunctionId) -> FunctionInfo {
        let info = |name: &str, params: Vec<Param>, returns: Type, doc: &str| FunctionInfo {
            name: name.into(),
            params,
            optional: 0,
            implied: false,
            returns,
            members: Vec::new(),
            length: None,
            aggregate: false,
            reads: AccessedFields::Nothing,
            writes: AccessedFields::Nothing,
            gives: ResultDimension::Unknown,
            doc: doc.into(),
        };
        let both = vec![Param::Object(MODEL), Param::Object(DATA)];
        match function.0 {
            0 => FunctionInfo {
                implied: true,
                reads: AccessedFields::Everything,
                writes: AccessedFields::Fields(vec![FieldKey(7)]),
                ..info("mj.mj_setConst", both, Type::Void, "computes what follows from masses and inertias")
            },
            1 => FunctionInfo {
                optional: 1,
                writes: AccessedFields::Everything,
                ..info(
                    "mj.mj_resetDataKeyframe",
                    [both, vec![Param::Number]].concat(),
                    Type::Void,
                    "goes to a keyframe",
                )
            },
            2 => info("fail", Vec::new(), Type::Void, "always fails"),
            3 => info(
                "say",
                vec![Param::Text, Param::Boolean, Param::Any],
                Type::String,
                "joins its arguments",
            ),
            4 => FunctionInfo {
                aggregate: true,
                ..info("final", vec![Param::Lazy], Type::Number, "the last value")
            },
            5 => info("bodyId", vec![Param::Name(MODEL_BODIES)], Type::Number, "the number of a body"),
            6 => FunctionInfo {
                members: ["potential", "kinetic"].map(|n| (n.into(), Type::Number)).into(),
                ..info("energy", Vec::new(), Type::Record, "the energy")
            },
            7 => info("norm", vec![Param::Numbers], Type::Number, "the length of a vector"),
            _ => FunctionInfo {
                length: Some(3),
                ..info("bodyPos", vec![Param::Name(MODEL_BODIES)], Type::List, "the place of a body")
            },
        }
    }

    fn hint(&self, object: ObjectId, name: &str, _: Option<usize>) -> Option<String> {
        (object == DATA && name == "position").then(|| "positions of bodies are in `data.xpos`".into())
    }

    fn element_help(&self, field: FieldKey, index: usize) -> Option<String> {
        (field == FieldKey(1)).then(|| format!("coordinate {index}"))
    }

    fn is_continuous(&self, field: FieldKey, _: usize) -> bool {
        field.0 <= 3
    }

    fn entries_contain(&self, function: FunctionId) -> Option<&'static str> {
        (function.0 == 8).then_some(" / ")
    }

    fn role(&self, field: FieldKey, index: usize) -> Role {
        match (field.0, index) {
            (1, 3..=6 | 10..=13) => Role::NoAngle(&QUATERNION),
            (2, 11) => Role::Angle,
            _ => Role::Other,
        }
    }

    fn named_element(&self, field: FieldKey, index: usize) -> Option<String> {
        let (name, n) = match field.0 {
            1 => ("qpos", 7),
            2 => ("qvel", 6),
            _ => return None,
        };
        let joint = JOINTS.get(index / n)?;
        Some(format!("data.joint(\"{joint}\").{name}[{}]", index % n))
    }

    fn host_terms(&self) -> &'static HostTerms {
        &WORDS
    }

    fn refresh(&self) -> Option<String> {
        Some("mj_forward".into())
    }
}

/// The running host. Initially, element i of field k is 100 k + i, converted to the element type of the field.
pub(crate) struct World {
    pub(crate) fields: Vec<Vec<f64>>,
    pub(crate) calls: Vec<(u32, Vec<Value>)>,
}

impl World {
    pub(crate) fn new() -> World {
        let numbers = |k: usize| {
            let n: usize = FIELDS[k].1.iter().map(|n| n.unwrap_or(2)).product();
            (0..n).map(|i| FIELDS[k].3.keep((100 * k + i) as f64)).collect()
        };
        World { fields: (0..FIELDS.len()).map(numbers).collect(), calls: Vec::new() }
    }
}

impl Host for World {
    fn get(&self, field: FieldKey, index: usize) -> Option<f64> {
        self.fields[field.0 as usize].get(index).copied()
    }

    fn set(&mut self, field: FieldKey, index: usize, value: f64) -> Result<(), String> {
        if field.0 == 11 && value <= 0.0 {
            return Err("the timestep must be positive".into());
        }
        let (_, _, _, elem, _) = FIELDS[field.0 as usize];
        self.fields[field.0 as usize][index] = elem.keep(value);
        Ok(())
    }

    fn len(&self, field: FieldKey) -> usize {
        self.fields[field.0 as usize].len()
    }

    fn call(&mut self, heap: &mut Heap, function: FunctionId, args: &[Value]) -> Result<Value, String> {
        self.calls.push((function.0, args.to_vec()));
        match function.0 {
            2 => Err("this function always fails".into()),
            3 => Ok(Value::from(args.iter().map(Value::to_string).collect::<Vec<_>>().join("|").as_str())),
            5 => Ok(Value::Number(args[0].to_number() - 20.0)),
            6 => {
                let entries =
                    vec![("potential".into(), Value::Number(1.5)), ("kinetic".into(), Value::Number(2.5))];
                heap.record(entries).map_err(|_| "full".into())
            }
            7 => {
                let numbers = heap.to_numbers(&args[0]).unwrap_or_default();
                Ok(Value::Number(numbers.iter().map(|x| x * x).sum::<f64>().sqrt()))
            }
            8 => heap.numbers(&[args[0].to_number(), 1.0, 2.0]).map_err(|_| "full".into()),
            _ => Ok(Value::Undefined),
        }
    }
}

/// Compiles a valid expression and runs it in a new world.
pub(crate) fn evaluate(source: &str) -> Value {
    let mut globals = Globals::new();
    let compiled = Compiler::new(&Mock, &mut globals).expression(source);
    let program = compiled.program.unwrap_or_else(|| panic!("{source}: {:#?}", compiled.diagnostics));
    program.run(&mut World::new(), &mut Context::new(), None).unwrap()
}

/// Compiles valid statements and runs them; returns the world and `ctx.out`.
pub(crate) fn execute(source: &str) -> (World, Value) {
    let mut globals = Globals::new();
    let out = globals.define("out");
    let compiled = Compiler::new(&Mock, &mut globals).statements(source);
    let program = compiled.program.unwrap_or_else(|| panic!("{source}: {:#?}", compiled.diagnostics));
    let (mut world, mut context) = (World::new(), Context::for_globals(&globals));
    program.run(&mut world, &mut context, None).unwrap_or_else(|e| panic!("{source}: {e:?}"));
    (world, context.get(out).clone())
}
