-- A filter of pandoc for docs/reliability.md and docs/budget.md: plain 2^-23, sqrt(2) and <= become
-- formulas, the mark at the end of a proof stands at the right, and links between the pages lose
-- their targets, since both are one paper.
local relations = { ["<="] = "\\le", [">="] = "\\ge", ["+-"] = "\\pm" }

local function formula(text) return pandoc.Math("InlineMath", text) end

-- The text split at powers, as in 2^-23, and at subscripts of one letter, as in p_0.
local with_formulas
function with_formulas(text)
  local out = {}
  local function add(piece) if piece ~= "" then table.insert(out, pandoc.Str(piece)) end end
  local before, letter, index, after = text:match("^(.-)(%a)_%((%w%-%w)%)(.*)$")
  if letter then
    out = with_formulas(before)
    table.insert(out, formula(letter .. "_{" .. index .. "}"))
    for _, x in ipairs(with_formulas(after)) do table.insert(out, x) end
    return out
  end
  while text ~= "" do
    local from, to, base, mark, raised = text:find("(%f[%w]%w*)([%^_])(%-?%w+)")
    if not from then
      from, to, base, mark, raised = text:find("()(%^)(%-?%w+)")
      base = ""
    end
    if not from then break end
    local plain = mark == "^" and raised:match("^%-?%d*%a?$") or mark == "_" and #base == 1 and #raised <= 2
    if plain then
      add(text:sub(1, from - 1))
      table.insert(out, formula(base .. mark .. "{" .. raised .. "}"))
    else
      add(text:sub(1, to))
    end
    text = text:sub(to + 1)
  end
  add(text)
  return out
end

local function root(text)
  local out, from = {}, 1
  while true do
    local start, stop, inner = text:find("sqrt%((%w+)%)", from)
    if not start then break end
    for _, x in ipairs(with_formulas(text:sub(from, start - 1))) do table.insert(out, x) end
    table.insert(out, formula("\\sqrt{" .. inner .. "}"))
    from = stop + 1
  end
  for _, x in ipairs(with_formulas(text:sub(from))) do table.insert(out, x) end
  return out
end

local function Str(element)
  if relations[element.text] then return formula(relations[element.text]) end
  if element.text == "∎" then return pandoc.RawInline("latex", "\\hfill\\rule{1.1ex}{1.1ex}") end
  if element.text == "∎." then return { pandoc.RawInline("latex", "\\rule{1.1ex}{1.1ex}"), pandoc.Str(".") } end
  return root(element.text)
end

local function Link(element)
  if element.target:match("^https?:") then return element end
  return element.content
end

-- Code may break at dots, at slashes and before words inside a name, so that lines keep to the margin.
local function Code(element)
  local text = element.text:gsub("[\\{}_%%&#$^~]", function(c)
    if c == "\\" then return "\\textbackslash{}" end
    if c == "^" or c == "~" then return "\\" .. c .. "{}" end
    return "\\" .. c
  end)
  text = text:gsub("%-%-", "-{}-")
  text = text:gsub("([./:])(%w)", "%1\\allowbreak{}%2"):gsub("(%l)(%u)", "%1\\allowbreak{}%2")
  return pandoc.RawInline("latex", "{\\small\\texttt{" .. text .. "}}")
end

-- In a table wider than the page, the widths of columns are proportional to their longest cells. Only 9 to 60 letters count.
local function Table(element)
  local longest = {}
  local function see(rows)
    for _, row in ipairs(rows) do
      for i, cell in ipairs(row.cells) do
        longest[i] = math.max(longest[i] or 0, #pandoc.utils.stringify(cell.contents))
      end
    end
  end
  see(element.head.rows)
  for _, body in ipairs(element.bodies) do see(body.body) end
  local sum, weights = 0, 0
  for i, length in ipairs(longest) do
    sum = sum + length
    longest[i] = math.max(9, math.min(length, 60))
    weights = weights + longest[i]
  end
  for i, spec in ipairs(element.colspecs) do
    element.colspecs[i] = { spec[1], sum > 90 and longest[i] / weights or nil }
  end
  return element
end

-- The first heading of each page is the title of the paper, or of its second part.
local seen = 0
local function Header(element)
  if element.level > 1 then
    element.level = element.level - 1
    return element
  end
  seen = seen + 1
  if seen == 1 then return {} end
  if seen == 2 then
    return pandoc.RawBlock("latex", "\\clearpage\\part*{" .. pandoc.utils.stringify(element.content) .. "}")
  end
  return element
end

-- Table runs first, since it measures the plain text of cells.
return { { Table = Table }, { Str = Str, Link = Link, Code = Code, Header = Header } }
