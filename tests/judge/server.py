"""Owns the models and data of a second judge and answers the calls of python.mjs, one after the other: server.py ASKED ANSWERS.

A message is two lengths, a text of JSON and bytes. It carries what JavaScript has written since the last one and a call; the answer
carries what the call gives and, of all that was ever read, what is no longer as JavaScript knows it.
"""
import json
import struct
import sys

import mujoco
import numpy as np

ARRAYS = ('float64', 'float32', 'int32', 'uint8', 'int8')  # flags are left out, as by the JavaScript build
objects = {}  # models and data, by number
watched = {}  # (number, path) of what JavaScript has read: the bytes that it knows


def describe(thing):
    """The fields of an object: arrays, numbers, parts with fields of their own, and lists of such parts."""
    fields = {}
    for name in dir(thing):
        if name.startswith('_') or callable(value := getattr(thing, name)) or isinstance(value, (str, bytes, mujoco.MjModel)):
            continue
        if isinstance(value, np.ndarray):
            if value.dtype.name in ARRAYS:
                fields[name] = 'array'
        elif isinstance(value, (bool, int, float)):
            fields[name] = 'number'
        else:
            fields[name] = {'list' if hasattr(value, '__len__') else 'part': describe(value)}
    return fields


def parent(number, path):
    thing, names = objects[number], path.split('.')
    for name in names[:-1]:
        thing = getattr(thing, name)
    return thing, names[-1]


def read(number, path):
    thing, name = parent(number, path)
    value = len(thing) if name == 'length' else getattr(thing, name)
    return np.ascontiguousarray(value) if isinstance(value, np.ndarray) else np.array([value], np.float64)


def write(owner, path, data):
    thing, name = parent(owner, path)
    value = getattr(thing, name)
    if isinstance(value, np.ndarray):
        value[...] = np.frombuffer(data, value.dtype).reshape(value.shape)
    else:
        number = np.frombuffer(data, np.float64)[0]
        setattr(thing, name, type(value)(number if isinstance(value, float) or np.isfinite(number) else 0))  # an integer as in JavaScript


def call(name, args, buffers):
    """A function of the library. Where it wants matrices, a row has a number for each degree of freedom."""
    function, given = getattr(mujoco, name), [argument(a, buffers) for a in args]
    try:
        return function(*given)
    except TypeError:
        nv = next((a.nv for a in given if isinstance(a, mujoco.MjModel)), 0)
        if not nv or not buffers or any(b.size % nv for b in buffers):
            raise
        return function(*(a.reshape(-1, nv) if isinstance(a, np.ndarray) else a for a in given))


def argument(told, buffers):
    """Numbers, texts and nothing stand for themselves."""
    if not isinstance(told, dict):
        return told
    kind, which = next(iter(told.items()))
    return objects[which] if kind == 'object' else buffers[which] if kind == 'buffer' else float(which)


def answer(message, body):
    """What one message asks for: the head of the answer, and its bytes."""
    start = 0
    for number, path, size in message['written']:
        known = body[start:start + size]
        start += size
        watched[number, path] = known
        write(number, path, known)
    do, head, parts = message['do'], {}, []
    if do in ('load', 'make'):
        made = mujoco.MjModel.from_xml_string(message['xml']) if do == 'load' else mujoco.MjData(objects[message['model']])
        objects[message['as']], head['fields'] = made, message['fields'] and describe(made)
    elif do == 'read':
        watched[message['object'], message['path']] = None
    elif do == 'drop':
        del objects[message['object']]
        for key in [key for key in watched if key[0] == message['object']]:
            del watched[key]
    elif do == 'call':
        buffers = []
        for size in message['buffers']:
            buffers.append(np.frombuffer(body, np.float64, size, start).copy())
            start += 8 * size
        result = call(message['name'], message['args'], buffers)
        if isinstance(result, float):
            buffers.append(np.array([result]))
            head['number'] = True
        else:
            head['result'] = result
        parts = [b.tobytes() for b in buffers]
    head['changed'] = changed = []
    for (number, path), known in watched.items():
        value = read(number, path)
        now = value.tobytes()
        if now != known:
            watched[number, path] = now
            changed.append([number, path, value.dtype.name, value.size])
            parts.append(now)
    return head, b''.join(parts)


def enums():
    kinds = {name: getattr(mujoco, name) for name in dir(mujoco) if name.startswith('mjt')}
    return {name: {k: int(v) for k, v in kind.__members__.items()} for name, kind in kinds.items() if hasattr(kind, '__members__')}


def main(asked, answers):
    mujoco.set_mju_user_warning(lambda text: None)  # else each is written into a file; they are counted all the same
    while len(lengths := asked.read(8)) == 8:
        head, body = struct.unpack('<II', lengths)
        message, body = json.loads(asked.read(head)), asked.read(body)
        try:
            if message['do'] == 'hello':
                reply, data = {'enums': enums(), 'functions': [n for n in dir(mujoco) if n.startswith(('mj_', 'mju_'))], 'changed': []}, b''
            else:
                reply, data = answer(message, body)
            text = json.dumps(reply).encode()
        except Exception as e:
            why = str(e).split('\nInvoked with')[0].strip()  # what follows has addresses
            text, data = json.dumps({'error': why or type(e).__name__}).encode(), b''
        answers.write(struct.pack('<II', len(text), len(data)) + text + data)
        answers.flush()


if len(sys.argv) == 3:  # without pipes there is nobody to serve, but all that it takes is here
    with open(sys.argv[1], 'rb') as asked, open(sys.argv[2], 'wb') as answers:
        main(asked, answers)
