--[[
A filter of pandoc and Quarto: fences with labs and quizzes become <sim-lab> and <lesson-quiz> in HTML. Other formats keep the code.

Metadata under `labspec`:
  models      the folder of the MJCF files; otherwise the nearest folder `models` beside the first input file or above it
  models-url  the address from which the page fetches models; no model is then written into the page
  script      the address of the elements' script, `labspec-elements.js` by default; `false` writes no script

JSON is copied as it is written, without `verify` and `lint`: numbers and the order of keys stay the same.
]]

local MAX_DEPTH = 200
local MAX_MODEL = 16 * 1024 * 1024

-- JSON: a reader that checks a text and copies it ---------------------------------------------------------------------

local function fail(message)
  error({ labspec = message }, 0)
end

local function invalid(text, at)
  local before = text:sub(1, at - 1)
  local _, breaks = before:gsub('\n', '')
  fail(('invalid JSON (line %d, column %d)'):format(breaks + 1, #before:match('[^\n]*$') + 1))
end

local function skip_space(text, at)
  return text:match('^[ \t\r\n]*()', at)
end

-- The position after a string that begins at `at`.
local function string_end(text, at)
  local i = at + 1
  while true do
    i = text:match('^[^"\\%c]*()', i)
    local c = text:sub(i, i)
    if c == '"' then return i + 1 end
    if c == '\127' then
      i = i + 1
    elseif c == '\\' then
      local after = text:match('^\\["\\/bfnrt]()', i) or text:match('^\\u%x%x%x%x()', i)
      if not after then invalid(text, i) end
      i = after
    else
      invalid(text, i)
    end
  end
end

-- The position after a number, or nil.
local function number_end(text, at)
  local after = text:match('^%-?0()', at) or text:match('^%-?[1-9]%d*()', at)
  if not after then return nil end
  after = text:match('^%.%d+()', after) or after
  after = text:match('^[eE][+-]?%d+()', after) or after
  local value = tonumber(text:sub(at, after - 1))
  if value == math.huge or value == -math.huge then fail('a number is out of range') end
  return after
end

-- The text that a string of JSON without surrogates stands for; keys and names of models have none in practice.
local function string_value(json)
  local short = { b = '\b', f = '\f', n = '\n', r = '\r', t = '\t' }
  local inside = json:sub(2, -2):gsub('\\u(%x%x%x%x)', function(hex)
    local code = tonumber(hex, 16)
    -- A backslash must not become an escape of its own.
    return code == 0x5c and '\\\\' or utf8.char(code)
  end)
  return (inside:gsub('\\(.)', function(c) return short[c] or c end))
end

local read_value

-- Reads the members of an object. A member is { key, text of the key, value }.
local function read_object(text, at, depth)
  local members = {}
  at = skip_space(text, at + 1)
  if text:sub(at, at) == '}' then return { kind = 'object', members = members }, at + 1 end
  while true do
    if text:sub(at, at) ~= '"' then invalid(text, at) end
    local after = string_end(text, at)
    local written = text:sub(at, after - 1)
    at = skip_space(text, after)
    if text:sub(at, at) ~= ':' then invalid(text, at) end
    local value
    value, at = read_value(text, skip_space(text, at + 1), depth + 1)
    members[#members + 1] = { key = string_value(written), written = written, value = value }
    at = skip_space(text, at)
    local c = text:sub(at, at)
    if c == '}' then return { kind = 'object', members = members }, at + 1 end
    if c ~= ',' then invalid(text, at) end
    at = skip_space(text, at + 1)
  end
end

local function read_list(text, at, depth)
  local items = {}
  at = skip_space(text, at + 1)
  if text:sub(at, at) == ']' then return { kind = 'list', items = items }, at + 1 end
  while true do
    items[#items + 1], at = read_value(text, at, depth + 1)
    at = skip_space(text, at)
    local c = text:sub(at, at)
    if c == ']' then return { kind = 'list', items = items }, at + 1 end
    if c ~= ',' then invalid(text, at) end
    at = skip_space(text, at + 1)
  end
end

read_value = function(text, at, depth)
  if depth > MAX_DEPTH then fail('the JSON is nested too deeply') end
  local c = text:sub(at, at)
  if c == '{' then return read_object(text, at, depth) end
  if c == '[' then return read_list(text, at, depth) end
  local after
  if c == '"' then
    after = string_end(text, at)
  else
    after = number_end(text, at) or text:match('^true()', at) or text:match('^false()', at) or text:match('^null()', at)
  end
  if not after then invalid(text, at) end
  return { kind = c == '"' and 'string' or 'other', written = text:sub(at, after - 1) }, after
end

local function read_json(text)
  local value, at = read_value(text, skip_space(text, 1), 1)
  at = skip_space(text, at)
  if at <= #text then invalid(text, at) end
  if value.kind ~= 'object' then fail('its JSON is not an object') end
  return value
end

local function write_json(value)
  local parts = {}
  if value.kind == 'object' then
    for i, member in ipairs(value.members) do parts[i] = member.written .. ':' .. write_json(member.value) end
    return '{' .. table.concat(parts, ',') .. '}'
  elseif value.kind == 'list' then
    for i, item in ipairs(value.items) do parts[i] = write_json(item) end
    return '[' .. table.concat(parts, ',') .. ']'
  end
  return value.written
end

-- The value of a key: the last one counts, as in the engine.
local function get(object, key)
  local found
  for _, member in ipairs(object.members) do
    if member.key == key then found = member.value end
  end
  return found
end

-- Fences --------------------------------------------------------------------------------------------------------------

local function remove_claims(object)
  local members = {}
  for _, member in ipairs(object.members) do
    if member.key ~= 'verify' and member.key ~= 'lint' then members[#members + 1] = member end
  end
  object.members = members
  local questions = get(object, 'questions')
  for _, question in ipairs(questions and questions.kind == 'list' and questions.items or {}) do
    if question.kind == 'object' then
      remove_claims(question)
      local sim = get(question, 'sim')
      if sim and sim.kind == 'object' then remove_claims(sim) end
    end
  end
end

-- The elements recognize a comparison by its list of integrators; an empty list names all.
local function add_comparison(object)
  local listed = get(object, 'integrators')
  if listed and listed.kind == 'list' then return end
  object.members[#object.members + 1] = { key = 'integrators', written = '"integrators"', value = { kind = 'list', items = {} } }
end

-- The labs of a content: itself, or those of its questions.
local function labs_of(kind, content)
  if kind == 'lab' then return { content } end
  local labs = {}
  local questions = get(content, 'questions')
  for _, question in ipairs(questions and questions.kind == 'list' and questions.items or {}) do
    local sim = question.kind == 'object' and get(question, 'sim') or nil
    if sim and sim.kind == 'object' then labs[#labs + 1] = sim end
  end
  return labs
end

local function escape(text)
  return (text:gsub('[&<>"\']', { ['&'] = '&amp;', ['<'] = '&lt;', ['>'] = '&gt;', ['"'] = '&quot;', ["'"] = '&#39;' }))
end

-- JSON for a script element: nothing in it ends the element or opens another one.
local function json_in_script(json)
  return (json:gsub('[<>]', { ['<'] = '\\u003c', ['>'] = '\\u003e' }):gsub('\226\128[\168\169]', { ['\226\128\168'] = '\\u2028', ['\226\128\169'] = '\\u2029' }))
end

local function without_comments(xml)
  local out, at = {}, 1
  while true do
    local start = xml:find('<!--', at, true)
    if not start then return table.concat(out) .. xml:sub(at) end
    out[#out + 1] = xml:sub(at, start - 1)
    local _, stop = xml:find('-->', start + 4, true)
    if not stop then return nil end
    at = stop + 1
  end
end

-- The text of a model on one line, if a script element can contain it.
local function model_in_script(xml)
  local text = without_comments(xml:gsub('^\239\187\191', ''))
  if not text then return nil end
  text = text:gsub('^%s+', ''):gsub('%s+$', ''):gsub('%s*[\r\n]%s*', ' ')
  local lower = text:lower()
  for _, part in ipairs({ '<!--', '<script', '</script', '<!doctype', '<![cdata[' }) do
    if lower:find(part, 1, true) then return nil end
  end
  return text
end

-- Models --------------------------------------------------------------------------------------------------------------

local settings = { models = nil, url = nil, script = 'labspec-elements.js' }

local function read_file(path)
  local file = io.open(path, 'rb')
  if not file then return nil end
  local text = file:read(MAX_MODEL + 1)
  file:close()
  return text
end

local function model_paths(name)
  if settings.models then return { settings.models .. '/' .. name .. '.xml' } end
  local input = PANDOC_STATE.input_files[1]
  local folder = input and pandoc.path.make_relative(pandoc.path.directory(input), pandoc.system.get_working_directory()) or '.'
  local paths = { pandoc.path.join({ folder, 'models', name .. '.xml' }) }
  -- Above the lesson, up to the working directory.
  while not pandoc.path.is_absolute(folder) and folder ~= '.' and folder ~= '' do
    folder = pandoc.path.directory(folder)
    paths[#paths + 1] = pandoc.path.join({ folder, 'models', name .. '.xml' })
  end
  return paths
end

local function read_model(name)
  -- No separator gets into a path, and no name begins with a dot.
  if not name:match('^[%w_][%w_. -]*$') then fail(('the name of the model `%s` is not a file name'):format(name)) end
  for _, path in ipairs(model_paths(name)) do
    local text = read_file(path)
    if text then
      if #text > MAX_MODEL then fail(('the model `%s` is too large'):format(name)) end
      local plain = without_comments(text) or text
      if plain:find('%sfile%a*%s*=') then
        fail(('the model `%s` reads other files, so pages must fetch it: set the address of the folder of models'):format(name))
      end
      return text
    end
  end
  fail(('the model `%s` does not exist in the folder of models'):format(name))
end

local function json_string(text)
  local short = { ['"'] = '\\"', ['\\'] = '\\\\' }
  return '"' .. text:gsub('[%c"\\]', function(c) return short[c] or ('\\u%04x'):format(c:byte()) end) .. '"'
end

-- The scripts of the models of a content. A model that no script can contain becomes the `xml` of its labs.
local function place_models(kind, content)
  local scripts, placed = {}, {}
  if settings.url then return scripts end
  for _, lab in ipairs(labs_of(kind, content)) do
    local model = get(lab, 'model')
    if model and model.kind == 'string' then
      local name = string_value(model.written)
      local xml = read_model(name)
      local text = model_in_script(xml)
      if text and not placed[name] then
        scripts[#scripts + 1] = ('<script type="model/mjcf" data-name="%s">%s</script>'):format(escape(name), text)
      elseif not text then
        for _, member in ipairs(lab.members) do
          if member.key == 'model' then
            member.key, member.written = 'xml', '"xml"'
            member.value = { kind = 'string', written = json_string(xml) }
          end
        end
      end
      placed[name] = true
    end
  end
  return scripts
end

-- Elements ------------------------------------------------------------------------------------------------------------

-- `widgets`: by the text of a lab, the word after `lab`, where it is another one than `simlab`.
local count, ids, widgets = 0, {}, {}

local function unique_id(wanted)
  local id, n = wanted, 2
  while ids[id] do id, n = wanted .. '-' .. n, n + 1 end
  ids[id] = true
  return id
end

local function slug(text)
  return (text:lower():gsub('[^%w\128-\255]+', '-'):gsub('^%-', ''):gsub('%-$', ''))
end

local function element(kind, text, widget)
  local content = read_json(text)
  remove_claims(content)
  if widget == 'integrators' then add_comparison(content) end
  local scripts = place_models(kind, content)
  local quiz = kind == 'quiz' and get(content, 'id') or nil
  local name = quiz and quiz.kind == 'string' and string_value(quiz.written) or ''
  local id = unique_id(kind == 'lab' and 'lab-' .. count or 'quiz-' .. slug(name))
  local tag = kind == 'lab' and 'sim-lab' or 'lesson-quiz'
  local address = settings.url and (' models="%s"'):format(escape(settings.url)) or ''
  return ('<%s id="%s"%s><script type="application/json">%s</script>%s</%s>'):format(
    tag, escape(id), address, json_in_script(write_json(content)), table.concat(scripts), tag)
end

-- The element of a fence; for a fence that cannot be read, a message and its source.
local function convert(kind, text, block, widget)
  if kind == 'lab' then count = count + 1 end
  local done, result = pcall(element, kind, text, widget)
  if done then return pandoc.RawBlock('html', result) end
  if type(result) ~= 'table' or not result.labspec then error(result, 0) end
  local message = ('This %s cannot be displayed: %s'):format(kind, result.labspec)
  io.stderr:write('labspec: ' .. message .. '\n')
  local code = block.t == 'CodeBlock' and block or pandoc.CodeBlock(text, pandoc.Attr('', { 'json' }))
  local note = pandoc.Div({ pandoc.Para({ pandoc.Strong({ pandoc.Str(message .. '.') }) }) }, pandoc.Attr('', { 'labspec-message' }, { role = 'note' }))
  return { note, code }
end

local function is_page()
  return FORMAT:match('html') ~= nil or FORMAT == 'revealjs' or FORMAT == 'slidy' or FORMAT == 's5' or FORMAT == 'dzslides'
end

-- The words after `lab` that name labs; those of other widgets stay.
local is_lab = { simlab = true, integrators = true }

local function code_block(block)
  local first, second = block.classes[1], block.classes[2]
  if first == 'quiz' then return convert('quiz', block.text, block) end
  if first ~= 'lab' then return nil end
  local widget = second or widgets[block.text] or 'simlab'
  return is_lab[widget] and convert('lab', block.text, block, widget) or nil
end

-- In pandoc's own Markdown, an opening line of two words makes a fence inline code, in which line breaks are spaces. JSON has none
-- in its strings, so that nothing is lost.
local function inline_fence(block)
  local code = #block.content == 1 and block.content[1] or nil
  if not code or code.t ~= 'Code' then return nil end
  local widget, text = code.text:match('^lab +(%w+) +({.*})$')
  return is_lab[widget or ''] and convert('lab', text, block, widget) or nil
end

-- Pandoc drops the second word of an opening line: the sources say which word it was.
local function find_widgets()
  for _, path in ipairs(PANDOC_STATE.input_files) do
    local source = (read_file(path) or ''):gsub('\r', '')
    for marks, widget, body in source:gmatch('\n?(```+)%s*lab +([%w_-]+)[^\n]*\n(.-)\n```') do
      if #marks >= 3 and widget ~= 'simlab' then widgets[body] = widget end
    end
  end
end

local function text_of(value)
  return value ~= nil and pandoc.utils.stringify(value) or nil
end

local function read_settings(meta)
  local own = meta.labspec
  if pandoc.utils.type(own) ~= 'table' then return end
  settings.models = text_of(own.models)
  settings.url = text_of(own['models-url'])
  if own.script == false then settings.script = nil else settings.script = text_of(own.script) or settings.script end
end

function Pandoc(document)
  if not is_page() then return nil end
  read_settings(document.meta)
  find_widgets()
  -- Blocks are visited in the order of the page, so that labs are numbered as in the lesson.
  document.blocks = document.blocks:walk({
    traverse = 'topdown', CodeBlock = code_block, Para = inline_fence, Plain = inline_fence,
  })
  if next(ids) and settings.script then
    document.blocks:insert(pandoc.RawBlock('html', ('<script type="module" src="%s"></script>'):format(escape(settings.script))))
  end
  return document
end
