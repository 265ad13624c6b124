// What the page says, in English and Chinese; terms are those of docs/glossary.md.

const WORDS = {
  en: {
    method: 'Method', numbers: 'Numbers', as_declared: 'as declared', unsigned: 'unsigned', signed: 'signed',
    binary: 'binary', hex: 'hexadecimal', keys: 'Keys', path: 'Path', wave: 'Wave', filter: 'Show signals whose name has', filter_short: 'filter signals',
    signal: 'Signal', value: 'Value', steps: 'Steps', program: 'Program', methods: 'Methods', diagram: 'Block diagram',
    report: 'Report', step: 'step', clock: 'clock', block: 'block', line: 'line', text: 'program', kind: 'move',
    clocks: 'clocks', error: 'error', feed: 'F → reached', at: 'at', place: 'place', theme: 'Light or dark', plane: 'Plane',
    play: 'Play', pause: 'Pause', first: 'To the start', last: 'To the end', before_block: 'Block before',
    next_block: 'Next block', before_step: 'Step before', next_step: 'Next step', before_clock: 'Clock before',
    next_clock: 'Next clock', speed: 'Speed', time: 'Clock', fit: 'Fit', zoom_in: 'Zoom in', zoom_out: 'Zoom out', large: 'Large or small',
    ideal: 'ideal curve', pulses: 'pulses', rapid: 'rapid', tool: 'tool', worst: 'greatest error', overflow: 'overflow',
    violated: 'violated', end: 'end', start: 'start', close: 'Close', no_moves: 'no moves', of: 'of',
    leading: 'motion', flags: 'flags that stay 0', raised: 'flags that rise', signals_of: 'Signals and their values at the cursor', steps_of: 'Step table', program_of: 'Moves of the program',
    methods_of: 'Methods compared', others: 'All methods', path_of: 'Path of the tool over the ideal curve', waves_of: 'Waves of the signals above',
    transport: 'Time', no_stream: 'This browser cannot unpack the data of this page: it has no DecompressionStream.',
    key_clock: 'clock before, next clock', key_step: 'step before, next step', key_block: 'block before, next block',
    key_change: 'change of the selected signal before, next change', key_ends: 'start, end', key_play: 'play, pause',
    key_zoom: 'zoom the wave in, out', key_fit: 'show the whole wave', key_overflow: 'next overflow',
    key_worst: 'greatest error', key_radix: 'other numbers for the selected signal', key_select: 'select a signal',
    key_help: 'these keys', key_open: 'open the box with the focus in the block diagram, close it again', key_mouse: 'Mouse and touch',
    open: 'Open', scopes_of: 'Scopes around this drawing',
    mouse: 'Drag over the wave to move the cursor; Ctrl and wheel, or two fingers, zoom; Shift and wheel, or two fingers, pan. '
      + 'Drag the path to pan, turn the wheel to zoom, click to set the cursor where the tool is next to that place. '
      + 'Click a grey box of the block diagram to open it.',
  },
  zh: {
    'rapid ': '快速', 'line ': '直线', 'arc ': '圆弧', 'curve ': '曲线', 'start-up ': '起刀', 'cancel ': '撤刀', 'inserted line ': '插入直线', 'inserted arc ': '插入圆弧',
    method: '方法', numbers: '数制', as_declared: '按声明', unsigned: '无符号', signed: '有符号', binary: '二进制',
    hex: '十六进制', keys: '按键', path: '轨迹', wave: '波形', filter: '只显示名称中含有此文字的信号', filter_short: '筛选信号', signal: '信号', value: '值',
    steps: '插补计算过程', program: '程序', methods: '方法比较', diagram: '框图', report: '报告', step: '步', clock: '时钟',
    block: '程序段', line: '行', text: '程序', kind: '运动', clocks: '时钟数', error: '误差', feed: 'F → 实际', at: '位于',
    place: '位置', theme: '浅色或深色', plane: '平面', play: '播放', pause: '暂停', first: '到起点', last: '到终点', before_block: '上一程序段',
    next_block: '下一程序段', before_step: '上一步', next_step: '下一步', before_clock: '上一时钟', next_clock: '下一时钟',
    speed: '速度', time: '时钟', fit: '全部', zoom_in: '放大', zoom_out: '缩小', large: '整页或还原', ideal: '理想轮廓', pulses: '进给脉冲', rapid: '快速',
    tool: '刀具', worst: '最大误差', overflow: '溢出', violated: '违反', end: '终点', start: '起点', close: '关闭',
    no_moves: '无运动', of: '/', leading: '运动', flags: '始终为 0 的标志', raised: '出现 1 的标志', signals_of: '信号及其在光标处的值', steps_of: '插补计算过程表', program_of: '程序的各段运动',
    methods_of: '各方法比较', others: '所有方法', path_of: '刀具轨迹与理想轮廓', waves_of: '上列信号的波形', transport: '时间',
    no_stream: '此浏览器没有 DecompressionStream，无法解开本页的数据。',
    key_clock: '上一时钟、下一时钟', key_step: '上一步、下一步', key_block: '上一程序段、下一程序段',
    key_change: '所选信号的上一变化、下一变化', key_ends: '起点、终点', key_play: '播放、暂停', key_zoom: '波形放大、缩小',
    key_fit: '显示全部波形', key_overflow: '下一溢出', key_worst: '最大误差', key_radix: '所选信号换一种数制', key_select: '选择信号',
    key_help: '这些按键', key_open: '打开框图中有焦点的方框、返回', key_mouse: '鼠标与触摸', open: '打开', scopes_of: '此图的上级',
    mouse: '在波形上拖动以移动光标；按住 Ctrl 滚轮或双指缩放；按住 Shift 滚轮或双指平移。在轨迹上拖动以平移，滚轮缩放，点击则光标移到刀具最近该处之时。点击框图中的灰色方框以打开。',
  },
};

let language = 'en';

/** A word in the language of the page. */
function word(key) {
  return WORDS[language][key];
}

/** What kind of move one is; the report has it in English. */
function kindOf(move) {
  return WORDS[language][`${move.kind} `] ?? move.kind;
}

/** Puts the words into everything that has `data-word`; a title where it has `data-title`. */
function setWords() {
  document.documentElement.lang = language === 'zh' ? 'zh-CN' : 'en';
  for (const element of document.querySelectorAll('[data-word]')) element.textContent = word(element.dataset.word);
  for (const element of document.querySelectorAll('[data-label]')) element.setAttribute('aria-label', word(element.dataset.label));
  for (const element of document.querySelectorAll('[data-title]')) {
    element.title = word(element.dataset.title) + (element.dataset.key ? ` (${element.dataset.key})` : '');
    element.setAttribute('aria-label', element.title);
  }
  $('filter').placeholder = word('filter_short');
  const names = { values: 'signals_of', path: 'path_of', waves: 'waves_of', transport: 'transport', time: 'time', tabs: 'report' };
  for (const [id, key] of Object.entries(names)) document.getElementById(id).setAttribute('aria-label', word(key));
  const other = document.getElementById('language');
  [other.textContent, other.lang] = language === 'en' ? ['中文', 'zh'] : ['English', 'en'];
}
