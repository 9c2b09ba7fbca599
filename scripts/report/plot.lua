-- Parts of plots, as SVG that is drawn for the width of a phone and never scaled far from it: text
-- in it stays as large as that around it.
local h = require "html"

local plot = { WIDTH = 360, HEIGHT = 240, TOP = 10, BOTTOM = 36, LEFT = 50, SERIES = 8 }

local LETTER, LINE = 6.6, 13 -- of the labels: mean width, height

function plot.px(value)
  return string.format("%.1f", value)
end
local px = plot.px

local function letters(text)
  return utf8.len(text) or #text
end

function plot.text_width(text)
  return letters(text) * LETTER
end

function plot.shorten(text, most)
  if letters(text) <= most then return text end
  return text:sub(1, (utf8.offset(text, most) or most + 1) - 1) .. "…"
end

-- Shapes differ as well as colours, for those who cannot tell these.
local SHAPES = {
  function(x, y, r, more) more.cx, more.cy, more.r = px(x), px(y), px(r) return h.circle(more) end,
  function(x, y, r, more)
    more.x, more.y, more.width, more.height = px(x - r), px(y - r), px(2 * r), px(2 * r)
    return h.rect(more)
  end,
  function(x, y, r, more)
    more.d = string.format("M%.1f %.1fl%.1f %.1fh%.1fz", x, y - 1.3 * r, 1.2 * r, 2.2 * r, -2.4 * r)
    return h.path(more)
  end,
  function(x, y, r, more)
    more.d = string.format("M%.1f %.1fl%.1f %.1fl%.1f %.1fl%.1f %.1fz", x, y - 1.4 * r, 1.4 * r, 1.4 * r,
                           -1.4 * r, 1.4 * r, -1.4 * r, -1.4 * r)
    return h.path(more)
  end,
}

function plot.marker(series, x, y, r, title)
  local shape = SHAPES[(series - 1) % #SHAPES + 1]
  return shape(x, y, r, { class = "mark f" .. series, title and h.title(title) })
end

-- A key: what a colour and a shape stand for.
function plot.key(entries)
  local out = { class = "key" }
  for _, e in ipairs(entries) do
    out[#out + 1] = h.li {
      h.svg { class = "dot", viewBox = "0 0 12 12", ["aria-hidden"] = "true", plot.marker(e.series, 6, 6, 4) },
      e.label }
  end
  return h.ul(out)
end

-- Grid, ticks and names of both axes. `box`: left, right, top, bottom.
function plot.frame(box, x, y, x_label, y_label)
  local out = {}
  for _, tick in ipairs(y.ticks) do
    local at = px(y.place(tick))
    out[#out + 1] = h.line { class = "grid", x1 = box.left, x2 = box.right, y1 = at, y2 = at }
    out[#out + 1] = h.text { class = "tick", x = box.left - 6, y = px(y.place(tick) + 3.5), ["text-anchor"] = "end", y.text(tick) }
  end
  local last
  for _, tick in ipairs(x.ticks) do
    local at, text = x.place(tick), x.text(tick)
    local half = plot.text_width(text) / 2
    out[#out + 1] = h.line { class = "grid", x1 = px(at), x2 = px(at), y1 = box.bottom, y2 = box.bottom + 4 }
    if not last or at - half > last + 4 then
      out[#out + 1] = h.text { class = "tick", x = px(at), y = box.bottom + 16, ["text-anchor"] = "middle", text }
      last = at + half
    end
  end
  out[#out + 1] = h.line { class = "axis", x1 = box.left, x2 = box.right, y1 = box.bottom, y2 = box.bottom }
  out[#out + 1] = h.text { class = "name", x = px((box.left + box.right) / 2), y = box.bottom + 31,
                           ["text-anchor"] = "middle", plot.shorten(x_label, 40) }
  out[#out + 1] = h.text { class = "name", x = 2, y = 9, plot.shorten(y_label, 40) }
  return out
end

-- Moves labels ({ y }, wanted places) apart so that none lies on another, within top and bottom.
function plot.spread(labels, top, bottom)
  table.sort(labels, function(a, b) return a.y < b.y end)
  local at = top
  for _, label in ipairs(labels) do
    label.place = math.max(label.y, at)
    at = label.place + LINE
  end
  at = bottom
  for i = #labels, 1, -1 do
    labels[i].place = math.min(labels[i].place, at)
    at = labels[i].place - LINE
  end
end

local function overlap(a, b)
  return a.left < b.right and b.left < a.right and a.top < b.bottom and b.top < a.bottom
end

-- Where a label beside a point meets nothing: right, left, above, below; nil when nowhere. `taken`:
-- boxes that are in the way; the label's is added.
function plot.fit(text, x, y, box, taken)
  local width = plot.text_width(text)
  local tries = { { x + 8, y + 4 }, { x - 8 - width, y + 4 }, { x + 6, y - 8 }, { x - 6 - width, y - 8 },
                  { x + 6, y + 16 }, { x - 6 - width, y + 16 }, { x - width / 2, y - 14 }, { x - width / 2, y + 21 },
                  { x + 13, y + 4 }, { x - 13 - width, y + 4 } }
  for _, t in ipairs(tries) do
    local place = { left = t[1] - 2, right = t[1] + width + 2, top = t[2] - 10, bottom = t[2] + 3 }
    local free = place.left >= box.left and place.right <= box.right and place.top >= box.top and place.bottom <= box.bottom
    for _, other in ipairs(taken) do free = free and not overlap(place, other) end
    if free then
      taken[#taken + 1] = place
      return t[1], t[2]
    end
  end
end

return plot
