-- HTML as values: h.td { class = "n", "a < b" } is an element, its names are attributes, the rest
-- what it holds. Text is escaped wherever it stands, so that nothing out of a file can become
-- markup; only h.raw is not, and it is for our own style sheet alone.
local ELEMENT, RAW = {}, {}
local VOID = { meta = true, br = true, img = true }
local SPECIAL = { ["&"] = "&amp;", ["<"] = "&lt;", [">"] = "&gt;", ['"'] = "&quot;", ["'"] = "&#39;" }

local function escape(value)
  local text = tostring(value):gsub("[&<>\"']", SPECIAL)
  return (text:gsub("[\1-\8\11-\31\127]", "?"))
end

local add

-- By pairs, which goes in order and over what is nil: `condition and element or nil` is common.
local function add_all(out, list)
  for key, child in pairs(list) do
    if type(key) == "number" then add(out, child) end
  end
end

local function add_element(out, element)
  local content = element.content
  out[#out + 1] = "<" .. element.tag
  for name, value in pairs(content) do
    if type(name) == "string" and value then
      out[#out + 1] = value == true and " " .. name or " " .. name .. '="' .. escape(value) .. '"'
    end
  end
  out[#out + 1] = ">"
  if VOID[element.tag] then return end
  add_all(out, content)
  out[#out + 1] = "</" .. element.tag .. ">"
end

-- Lists are what they hold, false is nothing.
function add(out, value)
  if not value then return end
  if type(value) ~= "table" then
    out[#out + 1] = escape(value)
  elseif getmetatable(value) == ELEMENT then
    add_element(out, value)
  elseif getmetatable(value) == RAW then
    out[#out + 1] = value.text
  else
    add_all(out, value)
  end
end

local html = {}

function html.raw(text)
  return setmetatable({ text = text }, RAW)
end

function html.render(value)
  local out = {}
  add(out, value)
  return table.concat(out)
end

-- Any other name is a tag.
return setmetatable(html, {
  __index = function(_, tag)
    return function(content)
      if type(content) ~= "table" or getmetatable(content) then content = { content } end
      return setmetatable({ tag = tag, content = content }, ELEMENT)
    end
  end,
})
