"""Characters that sound alike (the tone aside), for the syllables of the Chinese stop phrases.

A line is a syllable in pinyin and the characters a speech recogniser may write for it.
"""

_LINES = """
an 按安暗岸案; ba 把吧八巴爸拔罢霸坝; bai 摆白百败拜; bao 保抱包报饱宝暴; bi 闭必比笔币壁毕鼻;
bian 边变便遍编鞭; bie 别憋鳖瘪; bu 不步布部补怖捕埠; cai 踩才猜菜采材财彩; che 车撤扯彻澈; ci 此次词慈磁刺辞;
cun 存村寸; da 打大达答搭; dai 待呆带代袋戴贷; dao 倒到道刀导岛盗; deng 等灯登邓凳瞪; di 地低底弟第递帝敌;
dian 电点店典垫; diao 掉吊调钓雕; ding 定订顶丁盯钉叮; dong 动懂冻洞东冬栋董; duan 断段短端锻;
fang 放方房防访芳; fei 废非飞费肥; fou 否; gai 该改盖概; gan 干赶感敢杆甘; ge 格个歌哥割各隔; gei 给;
gong 工公功共供攻宫; gou 够狗购构勾沟; guan 关管馆观官惯; guo 过国果锅; hou 后候厚猴; huo 火或活货获祸;
ji 急机及即几级极鸡集记击; jia 加家假价; jiao 脚叫角教交较; jie 接结节街解姐借; jin 进近紧金今禁尽;
jing 静经精京景竞净敬; jiu 就九酒久救旧; ju 距句局举; kai 开凯; kuai 快块筷; la 拉啦辣喇; lao 老劳; le 了乐勒;
li 立里力理离利例; liu 溜流留六; lun 轮论; ma 吗马妈麻嘛; man 慢满漫; me 么; men 们门; mo 莫末默模; na 那拿纳;
niu 钮牛扭; nong 弄农; ou 欧; pao 跑炮泡; peng 碰朋; ping 平瓶凭评; qi 弃气起器其七齐; qian 前钱浅千;
qiao 敲桥; qie 切且窃; qing 请轻清; qu 取去曲区; quan 全圈权拳; ren 任人认忍; sha 刹杀沙煞傻啥纱; shan 闪山;
shi 时是事十使式; shou 手收守首受; shu 输书树数; si 死四思; suan 算酸蒜; ta 它他她; tai 太台; ti 体提题;
ting 停听庭亭婷挺厅廷汀町艇霆; tong 统通同痛; tui 退推腿; wan 玩完晚碗; wang 往网望忘王; wei 位为未;
xi 熄西息喜细; xia 下夏吓虾侠瞎; xian 先线现鲜闲; xiang 想向像; xie 歇写谢些斜鞋; xiao 消笑小销效;
xing 行形型幸性; xiu 休修秀; xu 许需续须; yao 要药摇腰; ye 也夜叶业; yi 一以已移衣意易; yuan 原元圆远园;
zai 在再载灾; zan 暂赞攒; zhan 站占战展沾; zhe 着者这折; zhi 止指知只直制执纸值职滞植致; zhong 中终种重钟;
zhou 周州舟; zhu 住主助注驻竹足猪; zhuan 转专砖赚; zou 走奏揍; zu 阻组祖
"""

SYLLABLES: dict[str, str] = {
    character: syllable
    for syllable, characters in (entry.split() for entry in _LINES.replace("\n", " ").split(";"))
    for character in characters
}
"""By character, its syllable; characters that stand in no stop phrase and sound like none are left out."""

WORDS = """
不懂 不幸 步行 步走 先听 听听 听一听 挺直 挺住 停滞 写着 斜着 携着 占住 占着 战主 助手 猪手 主手 注脚 手工
首功 手部 收受 灯下 快艇 中指 终指 中段 中致 种植 精致 净值 精制 竞职 顶住 盯住 订住 打猪 大主 放气 取笑
把守 扒手 把手 八手 倒刺 短电 满着 购了 指动
"""
